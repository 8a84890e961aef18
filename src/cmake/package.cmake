# The installed CMake package: find_package(goniofit), link goniofit::goniofit, include <goniofit/fit/fit.h>.

include(CMakePackageConfigHelpers)
set(GONIOFIT_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/goniofit)

# The public interface. A header that is not here may change without notice, and none here may include one that is not.
set(GONIOFIT_PUBLIC_HEADERS
  support/error.h support/instruction_set.h support/output_file.h
  geometry/angles.h geometry/pair.h geometry/samplings.h geometry/direction.h geometry/direction_batch.h geometry/domain.h
  terms/tiers.h terms/scalar.h terms/zenith.h terms/lambert_w.h terms/log1p_ratio.h terms/azimuth_difference.h
  terms/fresnel.h terms/shadowing.h terms/student_t_shadowing.h terms/effective_roughness.h terms/slope_distribution.h
  terms/he_torrance.h terms/he_torrance_series.h terms/he_torrance_saddle.h terms/chebyshev_patch.h
  terms/oren_nayar.h terms/v_cavity.h terms/v_cavity_integral.h
  basis/basis.h
  peers/peers.h peers/schlick_sampling.h peers/rational_fraction.h peers/approximation_quality.h
  brdf/material.h brdf/paper_samples.h brdf/evaluator.h brdf/batch_evaluator.h brdf/sampler.h brdf/sampling_lobes.h brdf/sampling_rows.h
  scan/scan.h scan/scan_domain.h scan/clipping.h scan/reflectance_readings.h
  fit/settings.h fit/loss.h fit/exclusions.h fit/likelihood_profile.h fit/identifiability.h fit/measurement_design.h fit/fit.h fit/residual_tests.h fit/diagnostics.h fit/selection.h fit/comparison.h
  io/scan_reader.h io/material_io.h io/recipe_io.h io/optical_constants.h io/reflectance_reader.h io/exr_table.h io/png_file.h
  synthetic/simulate.h synthetic/verify.h synthetic/judgement.h synthetic/recovery.h synthetic/exact_tests.h
  cost/timing.h cost/pareto.h cost/error_samples.h cost/candidate.h cost/model_error.h cost/reference.h cost/tradeoff.h cost/planner.h
  report/fit_report.h report/comparison_report.h report/verify_report.h report/plot.h report/plan_report.h report/tradeoff_report.h report/term_curves.h report/page.h report/material_result.h report/sphere_picture.h
  render/vec3.h render/scene.h render/scene_reader.h render/obj_reader.h render/path_observer.h render/renderer.h render/color.h render/picture_file.h render/picture_difference.h render/survey.h render/scene_plan.h render/scene_plan_report.h render/sphere_scene.h render/material_variants.h)
foreach(header IN LISTS GONIOFIT_PUBLIC_HEADERS)
  get_filename_component(room ${header} DIRECTORY)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/goniofit/${room})
endforeach()

configure_package_config_file(cmake/goniofitConfig.cmake.in ${PROJECT_BINARY_DIR}/goniofitConfig.cmake
  INSTALL_DESTINATION ${GONIOFIT_PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/goniofitConfigVersion.cmake COMPATIBILITY SameMinorVersion)

install(TARGETS goniofit_all EXPORT goniofitTargets)
install(EXPORT goniofitTargets NAMESPACE goniofit:: DESTINATION ${GONIOFIT_PACKAGE_DIR})
install(FILES ${PROJECT_BINARY_DIR}/goniofitConfig.cmake ${PROJECT_BINARY_DIR}/goniofitConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/FindNettle.cmake DESTINATION ${GONIOFIT_PACKAGE_DIR})
