# cmake --install, and the Debian package (scripts/package). The folders are GNUInstallDirs'; what belongs
# to the system (units, rules) goes where Debian 12 looks for it, relative to the prefix.

include(GNUInstallDirs)
set(KINTSUGI_PRIVATE ${CMAKE_INSTALL_LIBDIR}/kintsugi)   # our runtime of OpenNI2
set(KINTSUGI_SHARE ${CMAKE_INSTALL_DATADIR}/kintsugi)
set(packaging ${CMAKE_SOURCE_DIR}/scripts/packaging)
set(packaged ${CMAKE_BINARY_DIR}/packaging)              # what is made of it

# Programs.
kintsugi_targets(installed EXECUTABLE lcmtypes mapper segmenter viewer)
list(FILTER installed INCLUDE REGEX "^kintsugi-")
file(RELATIVE_PATH private_from_bin /${CMAKE_INSTALL_BINDIR} /${KINTSUGI_PRIVATE}/openni2)
file(RELATIVE_PATH libraries_from_bin /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
set_target_properties(${installed} PROPERTIES
  INSTALL_RPATH "$ORIGIN/${private_from_bin};$ORIGIN/${libraries_from_bin}")
install(TARGETS ${installed} RUNTIME)
# All that is installed, with the libraries and the Python package, which install themselves.
add_custom_target(kintsugi_programs DEPENDS ${installed} kintsugi_openni2_driver kintsugi_segmentation
                  kintsugi_bus)
if(TARGET kintsugi_python_package)
  add_dependencies(kintsugi_programs kintsugi_python_package)
endif()
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY TRUE)  # but no tests

# The private runtime of OpenNI2: our driver, and links to the system's library and drivers.
install(TARGETS kintsugi_openni2_driver LIBRARY DESTINATION ${KINTSUGI_PRIVATE}/openni2/OpenNI2/Drivers)
install(DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/openni2/ DESTINATION ${KINTSUGI_PRIVATE}/openni2
        PATTERN libKintsugi.so.0 EXCLUDE)

# The scripts that run them, under names of their own.
install(DIRECTORY scripts/lib DESTINATION ${KINTSUGI_SHARE}/scripts USE_SOURCE_PERMISSIONS
        PATTERN bench EXCLUDE PATTERN __pycache__ EXCLUDE)
install(PROGRAMS scripts/trio scripts/replay scripts/fleet scripts/check_host scripts/private_bus scripts/lcm-spy
        DESTINATION ${KINTSUGI_SHARE}/scripts)
file(RELATIVE_PATH SHARE_FROM_BIN /${CMAKE_INSTALL_BINDIR} /${KINTSUGI_SHARE})
foreach(script trio replay fleet check_host lcm-spy)
  string(REPLACE _ - name kintsugi-${script})
  set(SCRIPT ${script})
  configure_file(${packaging}/wrapper.sh ${packaged}/${name} @ONLY FILE_PERMISSIONS
                 OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  install(PROGRAMS ${packaged}/${name} TYPE BIN)
  list(APPEND installed ${name})
endforeach()
install(FILES ${CMAKE_BINARY_DIR}/share/kintsugi_types.jar DESTINATION ${KINTSUGI_SHARE} OPTIONAL)
install(FILES LICENSE THIRD_PARTY_NOTICES.md README.md CHANGELOG.md TYPE DOC)

# Completion and manual pages: of --help.
list(JOIN installed " " PROGRAMS)
configure_file(${packaging}/completion.bash ${packaged}/completion.bash @ONLY)
install(FILES ${packaged}/completion.bash
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME kintsugi-mapper)
list(FILTER installed EXCLUDE REGEX "^kintsugi-mapper$")
file(MAKE_DIRECTORY ${packaged}/completions)
foreach(name IN LISTS installed)  # bash looks for a file of the name of the command
  file(CREATE_LINK kintsugi-mapper ${packaged}/completions/${name} SYMBOLIC)
endforeach()
install(DIRECTORY ${packaged}/completions/ DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(DIRECTORY ${packaged}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} OPTIONAL)

# Services.
file(READ ${packaging}/service-hardening.conf hardening)
set(units kintsugi-mapper@ kintsugi-segmenter kintsugi-viewer)
if(TARGET kintsugi-objects)
  list(APPEND units kintsugi-objects)
endif()
foreach(unit IN LISTS units)
  file(READ ${packaging}/${unit}.service text)
  string(REPLACE /usr/bin/ ${CMAKE_INSTALL_FULL_BINDIR}/ text "${text}")
  file(CONFIGURE OUTPUT ${packaged}/${unit}.service CONTENT "${text}${hardening}" @ONLY)
  install(FILES ${packaged}/${unit}.service DESTINATION lib/systemd/system)
endforeach()
install(FILES ${packaging}/kintsugi.sysusers DESTINATION lib/sysusers.d RENAME kintsugi.conf)
install(FILES ${packaging}/kintsugi.sysctl DESTINATION lib/sysctl.d RENAME 60-kintsugi.conf)
install(FILES ${packaging}/kintsugi-cameras.rules DESTINATION lib/udev/rules.d RENAME 60-kintsugi-cameras.rules)
install(FILES ${packaging}/kintsugi.default DESTINATION ${KINTSUGI_SHARE})

# The package. Its dependencies are what the programs are linked with, and what the scripts call.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME kintsugi)
set(CPACK_PACKAGE_VENDOR "The Kintsugi developers")
set(CPACK_PACKAGE_CONTACT "The Kintsugi developers <kintsugi@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "incremental segmentation of dense RGB-D maps")
set(CPACK_PACKAGE_DESCRIPTION "Three processes over LCM: the mapper tracks a depth camera and fuses what it sees,
the segmenter keeps the map divided into segments while it grows, the viewer
draws it. With the programs to query, convert and evaluate maps and recordings.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The Python module is of this minor version.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
math(EXPR python_next_minor "${Python3_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PACKAGE_DEPENDS "liblcm-bin, libopenni2-0, python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${python_next_minor}), \
python3-numpy, iproute2, util-linux")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox, nftables, python3-numpy, systemd")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libeigen3-dev, parallel, slurm-client")  # find_package(Kintsugi); kintsugi-fleet
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${packaging}/postinst ${packaging}/postrm)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_STRIP_FILES ON)
include(CPack)
