# Failing calls, signals and threads: what a run leaves behind must be whole and the same.
# shb_robust_test(noun LABEL file arguments...): tests/robust/test_file.py over the programs.
function(shb_robust_test noun label file)
  shb_python_test(robust.${noun} ${label} robust/test_${file}.py $<TARGET_FILE_DIR:shroudhb>
    ${ARGN})
endfunction()

set(SCENE ${PROJECT_SOURCE_DIR}/cases/bring_your_own)
set(RING ${PROJECT_SOURCE_DIR}/cases/mistuned_ring)
shb_robust_test(same_bits INTEGRATION same_bits ${SCENE})
shb_robust_test(kills NIGHTLY kills ${SCENE} 2)
shb_robust_test(kills_many NIGHTLY kills ${SCENE} 170)
shb_robust_test(kills_ring NIGHTLY kills_ring ${RING} 2)
shb_robust_test(kills_ring_many NIGHTLY kills_ring ${RING} 60)
shb_robust_test(not_finite INTEGRATION not_finite ${SCENE})
shb_robust_test(numbers INTEGRATION numbers ${SCENE} contact.mu contact.n0[0])
shb_robust_test(numbers_all NIGHTLY numbers ${SCENE})

# the commands of the stages in one program, with the main of the modal stage under another name
set(COMMANDS ${PROJECT_SOURCE_DIR}/cases/commands)
add_executable(stage_server robust/stage_server.c ${COMMANDS}/shroudhb_modal.c)
target_link_libraries(stage_server PRIVATE shb_cases_commands shb_modal)
set_property(SOURCE ${COMMANDS}/shroudhb_modal.c
  APPEND PROPERTY COMPILE_OPTIONS -Dmain=modal_main -Wno-missing-prototypes)
shb_python_test(robust.damaged NIGHTLY robust/test_damaged.py $<TARGET_FILE:stage_server>
  ${SCENE} 12)
shb_python_test(robust.damaged_many NIGHTLY robust/test_damaged.py $<TARGET_FILE:stage_server>
  ${SCENE} 2000)

if(SHROUDHB_TSAN) # the target thread_test builds what the test needs
  add_executable(race robust/race.c)
  target_link_libraries(race PRIVATE OpenMP::OpenMP_C)
  add_custom_target(thread_test DEPENDS race shroudhb)
  shb_robust_test(threads SLOW threads $<TARGET_FILE:race> ${SCENE})
endif()
if(SHROUDHB_INSTRUMENTED) # libraries come too early, the heap is another, the same functions
  return()
endif()

add_library(locale MODULE robust/locale.c)
shb_robust_test(surroundings NIGHTLY surroundings $<TARGET_FILE:locale> ${SCENE})

add_executable(repeated_sweep robust/repeated_sweep.c)
target_link_libraries(repeated_sweep PRIVATE shb_cases_commands)
set(REPEATED $<TARGET_FILE:repeated_sweep> $<TARGET_FILE_DIR:shroudhb> ${SCENE})
shb_python_test(robust.repeated INTEGRATION robust/test_repeated.py ${REPEATED} 20 3)
shb_python_test(robust.repeated_many NIGHTLY robust/test_repeated.py ${REPEATED} 1000 1000)

shb_shell_test(robust.sanitizers NIGHTLY robust/sanitizers.sh ${PROJECT_SOURCE_DIR}
  ${PROJECT_BINARY_DIR}/sanitizers)

shb_robust_test(memory INTEGRATION memory ${SCENE})
add_library(fail_nth MODULE robust/fail_nth.c)
target_link_libraries(fail_nth PRIVATE PkgConfig::HDF5 ${CMAKE_DL_LIBS})
target_compile_definitions(fail_nth PRIVATE _GNU_SOURCE)
# shb_fail_test(noun LABEL arguments...): every call, or some, of some programs fails once.
function(shb_fail_test noun label)
  shb_robust_test(fail_nth${noun} ${label} fail_nth $<TARGET_FILE:fail_nth> ${SCENE} ${ARGN})
endfunction()
shb_fail_test("" NIGHTLY 2 mhb post)
shb_fail_test(_integrate NIGHTLY 2 integrate)
shb_fail_test(_study NIGHTLY 1 study)
shb_fail_test(_mesh NIGHTLY 12 mesh)
shb_fail_test(_open INTEGRATION 25 mhb:open)
shb_fail_test(_plan NIGHTLY 40 mesh:malloc)
shb_fail_test(_case NIGHTLY -110 mhb:malloc) # while the case and its defaults are read
shb_fail_test(_motion NIGHTLY -64 integrate:malloc) # while the time integration runs
shb_fail_test(_modal INTEGRATION 2 modal:malloc)
shb_fail_test(_all NIGHTLY)
