# Benchmarks: figure and error in one row, run by hand; --quick runs in the tests.
# shb_bench(noun sources...): bench/bench_noun.c and more become bench_noun.
function(shb_bench noun)
  list(TRANSFORM ARGN PREPEND bench/)
  add_executable(bench_${noun} bench/bench_${noun}.c ${ARGN})
  add_test(NAME bench.${noun} COMMAND bench_${noun} --quick)
endfunction()

shb_bench(contact method.c baseline.c march.c summary.c work_precision.c)
target_link_libraries(bench_contact PRIVATE shb_post tests_motions)
shb_bench(response child.c contact_faces.c precision.c shroud_face.c stiff_faces.c)
target_link_libraries(bench_response PRIVATE tests_models)
shb_bench(stability z_notch_settings.c)
target_link_libraries(bench_stability PRIVATE tests_models OpenMP::OpenMP_C)
shb_bench(integrate)
target_link_libraries(bench_integrate PRIVATE tests_models)
shb_bench(face_integration shroud_face.c z_notch_settings.c)
target_link_libraries(bench_face_integration PRIVATE tests_models)
shb_bench(ring)
target_link_libraries(bench_ring PRIVATE tests_models)
shb_bench(lasting z_notch_settings.c)
target_link_libraries(bench_lasting PRIVATE tests_models OpenMP::OpenMP_C)
shb_bench(study z_notch_settings.c)
target_link_libraries(bench_study PRIVATE shb_cases_study tests_models OpenMP::OpenMP_C)
shb_bench(mistuning z_notch_settings.c)
target_link_libraries(bench_mistuning PRIVATE tests_models)
# it counts their calls
target_link_options(bench_mistuning PRIVATE LINKER:--wrap=mhb_ring_system_factor
  LINKER:--wrap=mhb_arclength_set_tangent)
shb_bench(tracking z_notch_settings.c)
target_link_libraries(bench_tracking PRIVATE tests_models OpenMP::OpenMP_C)
shb_bench(optimisers)
target_link_libraries(bench_optimisers PRIVATE shb_cases_study)
shb_bench(elements z_notch.c)
target_link_libraries(bench_elements PRIVATE shb_modal)
shb_bench(residuals z_notch.c)
target_link_libraries(bench_residuals PRIVATE shb_modal m)
shb_bench(solver z_notch.c)
target_link_libraries(bench_solver PRIVATE shb_modal OpenMP::OpenMP_C m)
add_executable(bench_modal bench/bench_modal.c bench/z_notch.c)
target_link_libraries(bench_modal PRIVATE shb_modal m)
add_test(NAME bench.modal COMMAND bench_modal "$<$<BOOL:${SHROUDHB_CCX}>:${SHROUDHB_CCX}>" --quick)
add_executable(bench_cyclic bench/bench_cyclic.c bench/z_notch.c)
target_link_libraries(bench_cyclic PRIVATE shb_modal m)
add_test(NAME bench.cyclic COMMAND bench_cyclic "$<$<BOOL:${SHROUDHB_CCX}>:${SHROUDHB_CCX}>"
  --quick)
set_tests_properties(bench.elements bench.residuals bench.solver bench.modal bench.cyclic
  PROPERTIES
  ENVIRONMENT OPENBLAS_NUM_THREADS=1)
if(SHROUDHB_PYTHON)
  add_test(NAME bench.study_rates
    COMMAND ${SHROUDHB_PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/bench/bench_study_rates.py
            $<TARGET_FILE_DIR:shroudhb-study> --quick)
endif()
