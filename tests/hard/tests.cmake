# Regression on hard cases: figures and a verdict a row.
# By hand: gaps in the curves of a blade.
add_executable(hard_scan hard/scan.c)
target_link_libraries(hard_scan PRIVATE shb_mhb m)

add_library(tests_hard STATIC hard/verdict.c hard/power.c hard/floquet.c)
target_link_libraries(tests_hard PUBLIC tests_models)
foreach(noun three_degree jumps ends friction limits ring resonance balance pairs peaks isolas
    parameters)
  shb_test(hard ${noun} tests_hard)
endforeach()
target_sources(test_hard_pairs PRIVATE bench/shroud_face.c)
shb_test(hard gaps tests_hard)
shb_test(hard oblique tests_hard PkgConfig::LAPACKE)
target_sources(test_hard_oblique PRIVATE hard/oblique_cantilever.c hard/rigid_contact.c)
target_compile_definitions(test_hard_oblique PRIVATE SHROUDHB="$<TARGET_FILE:shroudhb>")
add_dependencies(test_hard_oblique programs)
