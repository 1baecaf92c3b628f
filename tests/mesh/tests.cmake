shb_test(mesh/base UNIT alloc arena axes crash_guard phases progress publish root shortest
  INTEGRATION memory LIBRARIES shb_mesh_base)
shb_test(mesh/process UNIT child report LIBRARIES shb_mesh_process)
shb_test(mesh/table UNIT csv LIBRARIES shb_mesh_table)
shb_test(mesh/core UNIT face_match group_checks group_rules jacobian triangle face_pairing
  file_format cyclic_sides LIBRARIES tests_fem)
shb_test(mesh/core UNIT fe_mesh regions PROGRAM test_mesh_core_gmsh
  LIBRARIES tests_box ${GMSH_LIBRARY})
shb_test(mesh/io UNIT source_files inp_read msh_check write INTEGRATION msh_read source
  LIBRARIES tests_box ${GMSH_LIBRARY})
shb_test(mesh/gmsh UNIT reading INTEGRATION solid_check LIBRARIES tests_box)
target_include_directories(test_mesh_core_gmsh PRIVATE ${GMSH_INCLUDE})
target_include_directories(test_mesh_io PRIVATE ${GMSH_INCLUDE})
shb_test(mesh/blade UNIT airfoil section_smoothing INTEGRATION disc hex_sweep shroud_angle
  SLOW blade
  LIBRARIES tests_box)
shb_test(mesh/blade UNIT scene LIBRARIES shb_case shb_mesh
  DEFINITIONS SCENE="${PROJECT_SOURCE_DIR}/cases/z_notch_blade/case.yaml")
shb_shell_test(mesh.blade.command INTEGRATION mesh/blade/test_command.sh
  $<TARGET_FILE_DIR:shroudhb>/shroudhb-mesh ${PROJECT_SOURCE_DIR}/cases/z_notch_blade/case.yaml
  $<BOOL:${SHROUDHB_SANITIZE}>)
