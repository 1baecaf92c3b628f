# What `cmake --install` copies, and the Debian package that CPack makes of it.
#   bin                   the programs, former ones as links
#   share/shroudhb        examples and pages, in the folders of the sources: their links hold
#   share/man             pages made from --help and the key table
#   share/bash-completion, share/zsh
include(GNUInstallDirs)
set(SHARED ${CMAKE_INSTALL_DATADIR}/shroudhb)

get_target_property(PROGRAMS programs MANUALLY_ADDED_DEPENDENCIES)
get_target_property(FORMER_PROGRAMS programs FORMER)
install(TARGETS ${PROGRAMS} RUNTIME)
foreach(command ${FORMER_PROGRAMS})
  install(FILES $<TARGET_FILE_DIR:shroudhb>/shroudhb-${command} TYPE BIN)
endforeach()

# ---------------------------------------------------------------- pages made by the programs
set(PAGES)
# manual_page(page program argument brief): makes manual/page from what the program prints.
function(manual_page page program argument brief)
  get_filename_component(name ${page} NAME_WE)
  get_filename_component(section ${page} LAST_EXT)
  string(SUBSTRING ${section} 1 -1 section)
  set(out ${PROJECT_BINARY_DIR}/manual/${page})
  add_custom_command(OUTPUT ${out} VERBATIM
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${program}> -DARGUMENT=${argument}
      -DNAME=${name} -DSECTION=${section} -DBRIEF=${brief} -DVERSION=${PROJECT_VERSION}
      -DOUT=${out} -P ${PROJECT_SOURCE_DIR}/cases/install/man_page.cmake
    DEPENDS ${program} ${PROJECT_SOURCE_DIR}/cases/install/man_page.cmake)
  install(FILES ${out} DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section})
  set(PAGES ${PAGES} ${out} PARENT_SCOPE)
endfunction()

manual_page(shroudhb.1 shroudhb --help "forced response of blades with shroud contact")
manual_page(shroudhb-pool.1 shroudhb "help samples" "a study or random rings on several machines")
foreach(command modal ${FORMER_PROGRAMS} check inspect contact)
  manual_page(shroudhb-${command}.1 shroudhb "help ${command}" "a command of shroudhb")
endforeach()
manual_page(shroudhb-case.5 shroudhb keys "the keys of a case file")
foreach(file study motion)
  manual_page(shroudhb-${file}.5 shroudhb "keys ${file}" "the keys of a ${file} file")
endforeach()

foreach(file case study)
  set(schema ${PROJECT_BINARY_DIR}/manual/${file}.schema.json)
  add_custom_command(OUTPUT ${schema} COMMAND shroudhb keys --schema=${file} > ${schema}
    DEPENDS shroudhb VERBATIM)
  install(FILES ${schema} DESTINATION ${SHARED})
  list(APPEND SCHEMAS ${schema})
endforeach()

add_custom_target(manual DEPENDS ${PAGES} ${SCHEMAS})
add_dependencies(programs manual)

# ---------------------------------------------------------------- examples, pages, completion
install(DIRECTORY docs DESTINATION ${SHARED} PATTERN figures EXCLUDE)
file(GLOB SCENES CONFIGURE_DEPENDS cases/*/README.md)
foreach(readme ${SCENES}) # a room has sources, a scene has none
  get_filename_component(folder ${readme} DIRECTORY)
  file(GLOB sources ${folder}/*.[ch] ${folder}/*.cmake)
  if(NOT sources)
    install(DIRECTORY ${folder} DESTINATION ${SHARED}/cases FILES_MATCHING
      PATTERN README.md PATTERN *.yaml PATTERN *.py PATTERN *.geo PATTERN picture*.svg)
  endif()
endforeach()
install(FILES cases/README.md DESTINATION ${SHARED}/cases)
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${SHARED})
install(FILES cases/install/completion.bash RENAME shroudhb
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES cases/install/completion.zsh RENAME _shroudhb
  DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES cases/install/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})

# ---------------------------------------------------------------- the package
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME shroudhb)
set(CPACK_PACKAGE_CONTACT "the shroudhb team <shroudhb@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "forced response of turbine blades with shroud contact")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON) # Depends: comes from the libraries that are linked
string(REPLACE ".so." "" gmsh_package ${GMSH_SONAME}) # loaded at run time: mesh/gmsh/api.c
set(CPACK_DEBIAN_PACKAGE_DEPENDS ${gmsh_package})
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS openmpi-bin)
include(CPack)
