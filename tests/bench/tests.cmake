# Benchmarks: figure and error in one row, run by hand; --quick runs in the tests.
# shb_bench(noun LABEL [SOURCES file...] [LIBRARIES library...] [LINK option...] [ARGUMENTS a...]):
# bench/bench_noun.c and more become bench_noun.
function(shb_bench noun label)
  cmake_parse_arguments(PARSE_ARGV 2 BENCH "" "" "SOURCES;LIBRARIES;LINK;ARGUMENTS")
  list(TRANSFORM BENCH_SOURCES PREPEND bench/)
  add_executable(bench_${noun} bench/bench_${noun}.c ${BENCH_SOURCES})
  target_link_libraries(bench_${noun} PRIVATE ${BENCH_LIBRARIES} OpenMP::OpenMP_C m)
  target_link_options(bench_${noun} PRIVATE ${BENCH_LINK})
  shb_add_test(bench.${noun} ${label} bench_${noun} ${BENCH_ARGUMENTS} --quick)
endfunction()

shb_bench(contact NIGHTLY SOURCES method.c baseline.c march.c summary.c work_precision.c
  LIBRARIES shb_post tests_motions)
shb_bench(response NIGHTLY SOURCES child.c contact_faces.c precision.c stiff_faces.c
  LIBRARIES tests_models)
foreach(noun stability integrate lasting tracking harmonics
    harmonic_cost)
  shb_bench(${noun} NIGHTLY LIBRARIES tests_models)
endforeach()
foreach(noun face_integration ring)
  shb_bench(${noun} NIGHTLY LIBRARIES tests_models)
endforeach()
foreach(noun study study_agreement)
  shb_bench(${noun} NIGHTLY SOURCES studied_designs.c LIBRARIES shb_cases_study tests_models)
endforeach()
# it counts their calls
shb_bench(mistuning NIGHTLY LIBRARIES tests_models
  LINK LINKER:--wrap=mhb_ring_system_factor LINKER:--wrap=mhb_arclength_set_tangent)
shb_bench(optimisers NIGHTLY LIBRARIES shb_cases_study)
shb_bench(elements NIGHTLY LIBRARIES shb_modal tests_box)
shb_bench(residuals NIGHTLY LIBRARIES shb_modal tests_box)
shb_bench(solid_volume NIGHTLY LIBRARIES tests_box)
shb_bench(solver NIGHTLY LIBRARIES shb_modal tests_box)
shb_bench(modal NIGHTLY LIBRARIES shb_modal tests_box
  ARGUMENTS "$<$<BOOL:${SHROUDHB_CCX}>:${SHROUDHB_CCX}>")
shb_bench(cyclic NIGHTLY LIBRARIES shb_modal tests_box
  ARGUMENTS "$<$<BOOL:${SHROUDHB_CCX}>:${SHROUDHB_CCX}>")
shb_python_test(bench.study_rates NIGHTLY bench/bench_study_rates.py
  $<TARGET_FILE_DIR:shroudhb> --quick)
