include(CMakePackageConfigHelpers)
include(PublicHeaders)

install(TARGETS slipstick)
install(FILES docs/reference/slipstick.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES docs/reference/slipstick.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME slipstick)
install(TARGETS slipstick_analytic slipstick_solver slipstick_convergence EXPORT slipstick-targets)
install(DIRECTORY ${SLIPSTICK_PUBLIC_INCLUDE}/slipstick DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT slipstick-targets NAMESPACE slipstick:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/slipstick)
configure_package_config_file(cmake/slipstickConfig.cmake.in ${PROJECT_BINARY_DIR}/slipstickConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/slipstick)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/slipstickConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/slipstickConfig.cmake ${PROJECT_BINARY_DIR}/slipstickConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/slipstick)
