# make deb: one Debian package of all files that `make install` installs, with its dependencies.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # `make deb` builds the packaged targets, not the tests
set(SLIPSTICK_MAINTAINER "slipstick developers <slipstick@users.noreply.github.com>" CACHE STRING "Whom a package names")
string(TIMESTAMP package_date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH if it is set

set(package_folder ${PROJECT_BINARY_DIR}/package)
file(WRITE ${package_folder}/changelog "slipstick (${PROJECT_VERSION}) unstable; urgency=low

  * Version ${PROJECT_VERSION}; what is new stands in CHANGELOG.md.

 -- ${SLIPSTICK_MAINTAINER}  ${package_date}
")
file(WRITE ${package_folder}/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: slipstick

Files: *
Copyright: 2026 slipstick developers
License: GPL-3+
 On Debian systems the whole text of this licence, the GNU General Public License, version 3, stands in
 /usr/share/common-licenses/GPL-3. Any later version may be chosen.
")
file(WRITE ${package_folder}/triggers "activate-noawait ldconfig\n")
file(WRITE ${package_folder}/shlibs "libslipstick ${PROJECT_VERSION_MAJOR} slipstick (>= ${PROJECT_VERSION})\n")
# Debian requires documentation and compressed manual pages; this changes the staged files only.
file(WRITE ${package_folder}/stage.cmake "set(root \"\${CPACK_TEMPORARY_DIRECTORY}/usr/share\")
set(package \"${package_folder}\")
file(COPY \"\${package}/copyright\" \"\${package}/changelog\" DESTINATION \"\${root}/doc/slipstick\")
execute_process(COMMAND gzip -9n \"\${root}/doc/slipstick/changelog\" \"\${root}/man/man1/slipstick.1\" COMMAND_ERROR_IS_FATAL ANY)
")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${package_folder}/stage.cmake)
set(CPACK_PACKAGE_CONTACT "${SLIPSTICK_MAINTAINER}")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${package_folder}/triggers ${package_folder}/shlibs)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy, python3-scipy, python3-matplotlib, python3-jinja2, python3-h5py")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libeigen3-dev, libfftw3-dev, libfmt-dev, libgsl-dev, libtomlplusplus-dev, nlohmann-json3-dev, pkg-config")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "verification of elastic torsional contacts with slip and stick")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "Solves the elastic torsional contact with slip and stick on a grid, and
exactly, by two sides that share no code, and compares the two: errors,
orders of convergence, error against time. It judges fields and numbers of
other programs, and gates them in continuous integration. The package holds
the program, the C library, C++ headers and libraries, and scenes.")
include(CPack)
