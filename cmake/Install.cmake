# Installed files, by component: each is a package of cmake/Packages.cmake.
include(CMakePackageConfigHelpers)
install(TARGETS ricochet_contact ricochet EXPORT ricochetTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(TARGETS ricochet_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)

# --- for programs of others ------------------------------------------------------------------------------------------
set(ricochet_cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/ricochet)
install(DIRECTORY src/ricochet/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ricochet COMPONENT development
  FILES_MATCHING PATTERN "*.hpp" PATTERN "distributed" EXCLUDE)
install(FILES ${CMAKE_BINARY_DIR}/generated/ricochet/version.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ricochet
  COMPONENT development)
install(EXPORT ricochetTargets NAMESPACE ricochet:: DESTINATION ${ricochet_cmake_folder} COMPONENT development)
configure_package_config_file(cmake/ricochetConfig.cmake.in ${CMAKE_BINARY_DIR}/ricochetConfig.cmake
  INSTALL_DESTINATION ${ricochet_cmake_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/ricochetConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/ricochetConfig.cmake ${CMAKE_BINARY_DIR}/ricochetConfigVersion.cmake
  DESTINATION ${ricochet_cmake_folder} COMPONENT development)

# --- files that the program needs at run time, its manual page and completion ----------------------------------------
install(FILES ${CMAKE_BINARY_DIR}/share/ricochet/figure.py ${CMAKE_BINARY_DIR}/share/ricochet/scene.py
  ${CMAKE_BINARY_DIR}/share/ricochet/show_in_paraview.py
  ${CMAKE_BINARY_DIR}/share/ricochet/viewer.html
  DESTINATION ${CMAKE_INSTALL_DATADIR}/ricochet COMPONENT program)
install(DIRECTORY benchmarks cases DESTINATION ${CMAKE_INSTALL_DATADIR}/ricochet COMPONENT program
  FILES_MATCHING PATTERN "*.toml" PATTERN "*.msh")
install(FILES ${RICOCHET_USER_FILES}/man/man1/ricochet.1$<$<BOOL:${RICOCHET_PACKAGE}>:.gz> DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${RICOCHET_USER_FILES}/bash-completion/completions/ricochet
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(FILES ${RICOCHET_USER_FILES}/fish/vendor_completions.d/ricochet.fish
  DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
# Debian separates the files of packages from those of an administrator.
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(ricochet_zsh_folder zsh/vendor-completions)
else()
  set(ricochet_zsh_folder zsh/site-functions)
endif()
install(FILES ${RICOCHET_USER_FILES}/zsh/vendor-completions/_ricochet
  DESTINATION ${CMAKE_INSTALL_DATADIR}/${ricochet_zsh_folder} COMPONENT program)

# --- documentation ---------------------------------------------------------------------------------------------------
# The sources of the pages, and the site if `./dev docs` has built it.
if(IS_DIRECTORY ${CMAKE_SOURCE_DIR}/build/site)
  install(DIRECTORY build/site/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/ricochet/html COMPONENT documentation)
endif()
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/ricochet COMPONENT documentation)
install(FILES README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/ricochet COMPONENT documentation)
# Packages have a separate file for the licence (cmake/Packages.cmake).
if(NOT RICOCHET_PACKAGE)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/ricochet COMPONENT documentation)
endif()
