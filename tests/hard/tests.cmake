# Regression on hard cases: figures and a verdict a row.
# By hand: gaps in the curves of a blade.
add_executable(hard_scan hard/scan.c)
target_link_libraries(hard_scan PRIVATE shb_mhb m)

add_library(tests_hard STATIC hard/verdict.c hard/power.c hard/floquet.c)
target_link_libraries(tests_hard PUBLIC tests_models)
shb_test(hard UNIT limits ring
  INTEGRATION three_degree jumps ends friction resonance balance peaks isolas parameters
  NIGHTLY pairs gaps LIBRARIES tests_hard)
shb_test(hard NIGHTLY oblique LIBRARIES PkgConfig::LAPACKE
  SOURCES hard/oblique_cantilever.c hard/rigid_contact.c
  DEFINITIONS SHROUDHB="$<TARGET_FILE:shroudhb>")
add_dependencies(test_hard programs)
