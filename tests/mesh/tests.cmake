shb_test(mesh/base phases fast shb_mesh_base)
shb_test(mesh/core fe_mesh fast tests_box ${GMSH_LIBRARY})
target_include_directories(test_mesh_core_fe_mesh PRIVATE ${GMSH_INCLUDE})
shb_test(mesh/core face_pairing fast tests_box)
shb_test(mesh/core regions fast tests_box ${GMSH_LIBRARY})
target_include_directories(test_mesh_core_regions PRIVATE ${GMSH_INCLUDE})
shb_test(mesh/io inp_read fast tests_box)
shb_test(mesh/io source fast tests_box ${GMSH_LIBRARY})
target_include_directories(test_mesh_io_source PRIVATE ${GMSH_INCLUDE})
shb_test(mesh/blade blade fast shb_mesh)
shb_test(mesh/blade hex_sweep fast shb_mesh)
shb_test(mesh/blade scene fast shb_case shb_mesh)
target_compile_definitions(test_mesh_blade_scene PRIVATE
  SCENE="${PROJECT_SOURCE_DIR}/cases/z_notch_blade/case.yaml")
add_test(NAME mesh.blade.command
  COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/mesh/blade/test_command.sh $<TARGET_FILE:shroudhb-mesh>
          ${PROJECT_SOURCE_DIR}/cases/z_notch_blade/case.yaml)
set_tests_properties(mesh.blade.command PROPERTIES LABELS fast TIMEOUT 240)
