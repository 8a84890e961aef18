# The report's page: its script and style are bundled with what they need of the npm registry into one C++ file. Sets
# GONIOFIT_PAGE_TEMPLATE to it. Once done, a build needs no network until package-lock.json changes.

find_program(GONIOFIT_NPM npm)
find_program(GONIOFIT_NODE NAMES node nodejs)
if(NOT GONIOFIT_NPM OR NOT GONIOFIT_NODE)
  message(FATAL_ERROR "npm or node is missing, which bundle the page of `goniofit report`: install the packages nodejs and npm")
endif()

set(page_source ${CMAKE_CURRENT_SOURCE_DIR}/page)
set(page_build ${CMAKE_CURRENT_BINARY_DIR}/page)
set(page_files build.mjs curves.js data.js details.js dom.js format.js lobes.js main.js maps.js page.css page.html plotting.js profiles.js
  state.js summary.js)
list(TRANSFORM page_files PREPEND ${page_source}/ OUTPUT_VARIABLE page_paths)
set(page_packages ${page_source}/package.json ${page_source}/package-lock.json)

add_custom_command(OUTPUT ${page_build}/installed
  COMMAND ${CMAKE_COMMAND} -E make_directory ${page_build}
  COMMAND ${CMAKE_COMMAND} -E copy ${page_packages} ${page_build}
  COMMAND ${CMAKE_COMMAND} -E chdir ${page_build} ${GONIOFIT_NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
  COMMAND ${CMAKE_COMMAND} -E touch ${page_build}/installed
  DEPENDS ${page_packages}
  COMMENT "Fetching what the report's page is made of" VERBATIM)

set(GONIOFIT_PAGE_TEMPLATE ${page_build}/page_template.cpp)
add_custom_command(OUTPUT ${GONIOFIT_PAGE_TEMPLATE}
  COMMAND ${CMAKE_COMMAND} -E copy ${page_paths} ${page_build}
  COMMAND ${CMAKE_COMMAND} -E chdir ${page_build} ${GONIOFIT_NODE} build.mjs ${GONIOFIT_PAGE_TEMPLATE}
  DEPENDS ${page_build}/installed ${page_paths}
  COMMENT "Bundling the report's page" VERBATIM)
