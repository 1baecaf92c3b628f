# box.c: a structured bar for tests of any folder; link tests_box.
add_library(tests_box STATIC mesh/box.c)
target_link_libraries(tests_box PUBLIC shb_mesh)

shb_test(mesh fe_mesh fast tests_box ${GMSH_LIBRARY})
target_include_directories(test_mesh_fe_mesh PRIVATE ${GMSH_INCLUDE})
shb_test(mesh phases fast shb_base)
shb_test(mesh inp fast tests_box)
shb_test(mesh pairing fast tests_box)
shb_test(mesh source fast tests_box ${GMSH_LIBRARY})
target_include_directories(test_mesh_source PRIVATE ${GMSH_INCLUDE})
shb_test(mesh regions fast tests_box ${GMSH_LIBRARY})
target_include_directories(test_mesh_regions PRIVATE ${GMSH_INCLUDE})
shb_test(mesh blade fast shb_mesh)
shb_test(mesh sweep fast shb_mesh)

if(TARGET shb_case)
  shb_test(mesh scene fast shb_case shb_mesh)
  target_compile_definitions(test_mesh_scene PRIVATE
    SCENE="${PROJECT_SOURCE_DIR}/cases/z_notch_blade/case.yaml")
endif()
if(TARGET shroudhb-mesh)
  add_test(NAME mesh.command
    COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/mesh/test_command.sh $<TARGET_FILE:shroudhb-mesh>
            ${PROJECT_SOURCE_DIR}/cases/z_notch_blade/case.yaml)
  set_tests_properties(mesh.command PROPERTIES LABELS fast TIMEOUT 240)
endif()
