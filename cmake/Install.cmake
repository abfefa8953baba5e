include(CMakePackageConfigHelpers)

install(TARGETS slipstick)
install(TARGETS slipstick_analytic slipstick_solver slipstick_convergence EXPORT slipstick-targets)
foreach(folder analytic solver convergence)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/slipstick
    FILES_MATCHING PATTERN "*.hpp" PATTERN "*_command.hpp" EXCLUDE PATTERN "gsl.hpp" EXCLUDE PATTERN "exact_answer.hpp" EXCLUDE
    PATTERN "elliptic_series.hpp" EXCLUDE PATTERN "certified/*" EXCLUDE PATTERN "tests" EXCLUDE PATTERN "allocations" EXCLUDE)
endforeach()
install(EXPORT slipstick-targets NAMESPACE slipstick:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/slipstick)
configure_package_config_file(cmake/slipstickConfig.cmake.in ${PROJECT_BINARY_DIR}/slipstickConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/slipstick)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/slipstickConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/slipstickConfig.cmake ${PROJECT_BINARY_DIR}/slipstickConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/slipstick)
