# By hand: gaps in the curves of a blade.
add_executable(hard_scan hard/scan.c)
target_link_libraries(hard_scan PRIVATE shb_mhb m)

set(HARD_SOURCES hard/verdict.c hard/power.c hard/floquet.c mhb/periodic.c mhb/three_degree.c mhb/random_model.c mhb/disturbed.c)
foreach(noun three_degree jumps ends friction limits ring resonance balance pairs peaks isolas parameters)
  shb_test(hard ${noun} fast shb_mhb)
  target_sources(test_hard_${noun} PRIVATE ${HARD_SOURCES})
endforeach()
target_sources(test_hard_pairs PRIVATE bench/shroud_face.c)
shb_test(hard gaps slow shb_mhb)
target_sources(test_hard_gaps PRIVATE ${HARD_SOURCES})
