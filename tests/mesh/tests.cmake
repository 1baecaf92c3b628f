shb_test(mesh/base arena shb_base)
shb_test(mesh/base root shb_base)
shb_test(mesh/base phases shb_base)
shb_test(mesh/core fe_mesh tests_box ${GMSH_LIBRARY})
target_include_directories(test_mesh_core_fe_mesh PRIVATE ${GMSH_INCLUDE})
shb_test(mesh/core face_pairing tests_box)
shb_test(mesh/core regions tests_box ${GMSH_LIBRARY})
target_include_directories(test_mesh_core_regions PRIVATE ${GMSH_INCLUDE})
shb_test(mesh/io inp_read tests_box)
shb_test(mesh/gmsh source tests_box ${GMSH_LIBRARY})
target_include_directories(test_mesh_gmsh_source PRIVATE ${GMSH_INCLUDE})
shb_test(mesh/blade blade shb_mesh)
shb_test(mesh/blade hex_sweep shb_mesh)
shb_test(mesh/blade scene shb_case shb_mesh)
target_compile_definitions(test_mesh_blade_scene PRIVATE
  SCENE="${PROJECT_SOURCE_DIR}/cases/z_notch_blade/case.yaml")
add_test(NAME mesh.blade.command
  COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/mesh/blade/test_command.sh $<TARGET_FILE:shroudhb-mesh>
          ${PROJECT_SOURCE_DIR}/cases/z_notch_blade/case.yaml)
