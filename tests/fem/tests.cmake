# support.c: meshes and comparisons, for the tests of fem/ and modal/; link tests_fem.
add_library(tests_fem STATIC fem/support.c)
target_link_libraries(tests_fem PUBLIC tests_box shb_fem PkgConfig::CMOCKA)

shb_test(fem tet10 fast tests_fem PkgConfig::OPENBLAS)
shb_test(fem hex20 fast tests_fem PkgConfig::OPENBLAS)
shb_test(fem finite fast tests_fem)
shb_test(fem material fast tests_fem)
shb_test(fem rotation fast tests_fem)
shb_test(fem stress fast tests_fem)
shb_test(fem pressure fast tests_fem PkgConfig::LAPACKE)
shb_test(fem assemble fast tests_fem)
shb_test(fem surface fast tests_fem)
shb_test(fem factor fast tests_fem)
