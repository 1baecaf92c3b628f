# box.c: a structured bar for tests of any folder; link tests_box.
add_library(tests_box STATIC mesh/box.c)
target_link_libraries(tests_box PUBLIC shb_mesh)

shb_test(mesh fe_mesh fast tests_box)
shb_test(mesh blade fast shb_mesh)
