# Run by ctest: cmake -D BUILD_DIR=... -P install_and_use.cmake

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nfailed (${status}):\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${SCRATCH_DIR})
set(prefix ${SCRATCH_DIR}/prefix)
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})

# A static library built with sanitizers links only into a program built with them.
set(flags "")
if(SANITIZE)
  set(flags -fsanitize=address,undefined)
endif()
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/consumer -B ${SCRATCH_DIR}/build -G Ninja -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
  -DCMAKE_CXX_FLAGS=${flags})
run(${CMAKE_COMMAND} --build ${SCRATCH_DIR}/build)

run(${SCRATCH_DIR}/build/consumer ${SCAN})
if(NOT output MATCHES "slope 0\\.085[0-9]+.*pdf positive.*peers 17.*page whole")
  message(FATAL_ERROR "the consumer printed '${output}', expected a slope of 0.085")
endif()

# The program is installed with the library.
run(${prefix}/bin/goniofit --help)
if(NOT output MATCHES "goniofit")
  message(FATAL_ERROR "the installed program printed '${output}' as its help")
endif()
