# Failing calls, signals and threads: what a run leaves behind must be whole and the same.
set(ROBUST ${CMAKE_CURRENT_SOURCE_DIR}/robust)

# shb_robust_test(noun file arguments...): tests/robust/test_file.py over the programs.
function(shb_robust_test noun file)
  add_test(NAME robust.${noun} ${CONFIGURATION}
    COMMAND ${SHROUDHB_PYTHON} -B ${ROBUST}/test_${file}.py $<TARGET_FILE_DIR:shroudhb> ${ARGN})
  set_tests_properties(robust.${noun} PROPERTIES SKIP_RETURN_CODE 77)
endfunction()

if(SHROUDHB_PYTHON)
  set(SCENE ${PROJECT_SOURCE_DIR}/cases/bring_your_own)
  shb_robust_test(same_bits same_bits ${SCENE})
  shb_robust_test(kills kills ${SCENE} 2)
  shb_robust_test(kills_ring kills_ring ${PROJECT_SOURCE_DIR}/cases/mistuned_ring 2)
  shb_robust_test(not_finite not_finite ${SCENE})
  if(NOT SHROUDHB_SANITIZE AND NOT SHROUDHB_FUZZ AND NOT SHROUDHB_TSAN) # libraries come too early
    add_library(locale MODULE robust/locale.c)
    shb_robust_test(surroundings surroundings $<TARGET_FILE:locale> ${SCENE})
  endif()
  shb_robust_test(numbers numbers ${SCENE} contact.mu contact.n0[0])
  set(CONFIGURATION CONFIGURATIONS nightly)
  shb_robust_test(numbers_all numbers ${SCENE})
  shb_robust_test(kills_many kills ${SCENE} 170)
  shb_robust_test(kills_ring_many kills_ring ${PROJECT_SOURCE_DIR}/cases/mistuned_ring 60)
  unset(CONFIGURATION)
  # the programs of the stages in one, each main under a name of its own
  set(COMMANDS ${PROJECT_SOURCE_DIR}/cases/commands)
  add_executable(stage_server robust/stage_server.c)
  target_link_libraries(stage_server PRIVATE shb_cases_commands shb_mesh shb_modal)
  foreach(stage mesh modal mhb post integrate)
    target_sources(stage_server PRIVATE ${COMMANDS}/shroudhb_${stage}.c)
    set_property(SOURCE ${COMMANDS}/shroudhb_${stage}.c
      APPEND PROPERTY COMPILE_OPTIONS -Dmain=${stage}_main -Wno-missing-prototypes)
  endforeach()
  add_test(NAME robust.damaged COMMAND ${SHROUDHB_PYTHON} -B ${ROBUST}/test_damaged.py
    $<TARGET_FILE:stage_server> ${SCENE} 12)
  add_test(NAME robust.damaged_many CONFIGURATIONS nightly COMMAND ${SHROUDHB_PYTHON} -B
    ${ROBUST}/test_damaged.py $<TARGET_FILE:stage_server> ${SCENE} 2000)
  if(NOT SHROUDHB_SANITIZE AND NOT SHROUDHB_FUZZ AND NOT SHROUDHB_TSAN) # their heap is another
    add_executable(repeated_sweep robust/repeated_sweep.c ${COMMANDS}/shroudhb_mhb.c)
    target_link_libraries(repeated_sweep PRIVATE shb_cases_commands)
    set(REPEATED ${ROBUST}/test_repeated.py $<TARGET_FILE:repeated_sweep>
      $<TARGET_FILE_DIR:shroudhb> ${SCENE})
    add_test(NAME robust.repeated COMMAND ${SHROUDHB_PYTHON} -B ${REPEATED} 20 3)
    add_test(NAME robust.repeated_many CONFIGURATIONS nightly
      COMMAND ${SHROUDHB_PYTHON} -B ${REPEATED} 1000 1000)
    set_tests_properties(robust.repeated robust.repeated_many PROPERTIES SKIP_RETURN_CODE 77)
  endif()
  set_tests_properties(robust.damaged robust.damaged_many PROPERTIES SKIP_RETURN_CODE 77)
  if(NOT SHROUDHB_SANITIZE AND NOT SHROUDHB_FUZZ AND NOT SHROUDHB_TSAN)
    add_test(NAME robust.sanitizers CONFIGURATIONS nightly COMMAND sh ${ROBUST}/sanitizers.sh
      ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/sanitizers)
  endif()
  if(SHROUDHB_TSAN) # the target thread_test builds what the test needs
    add_executable(race robust/race.c)
    target_link_libraries(race PRIVATE OpenMP::OpenMP_C)
    add_custom_target(thread_test DEPENDS race shroudhb-mesh shroudhb-modal shroudhb-mhb
      shroudhb-integrate shroudhb-design shroudhb-study)
    shb_robust_test(threads threads $<TARGET_FILE:race> ${SCENE})
  endif()
  # sanitizers replace the same functions
  if(NOT SHROUDHB_SANITIZE AND NOT SHROUDHB_FUZZ AND NOT SHROUDHB_TSAN)
    shb_robust_test(memory memory ${SCENE})
    add_library(fail_nth MODULE robust/fail_nth.c)
    target_link_libraries(fail_nth PRIVATE PkgConfig::HDF5 ${CMAKE_DL_LIBS})
    target_compile_definitions(fail_nth PRIVATE _GNU_SOURCE)
    shb_robust_test(fail_nth fail_nth $<TARGET_FILE:fail_nth> ${SCENE} 2 mhb post)
    shb_robust_test(fail_nth_integrate fail_nth $<TARGET_FILE:fail_nth> ${SCENE} 2 integrate)
    shb_robust_test(fail_nth_study fail_nth $<TARGET_FILE:fail_nth> ${SCENE} 1 study)
    shb_robust_test(fail_nth_mesh fail_nth $<TARGET_FILE:fail_nth> ${SCENE} 12 mesh)
    shb_robust_test(fail_nth_open fail_nth $<TARGET_FILE:fail_nth> ${SCENE} 25 mhb:open)
    shb_robust_test(fail_nth_plan fail_nth $<TARGET_FILE:fail_nth> ${SCENE} 40 mesh:malloc)
    # while the case and its defaults are read
    shb_robust_test(fail_nth_case fail_nth $<TARGET_FILE:fail_nth> ${SCENE} -110 mhb:malloc)
    # while the time integration runs
    shb_robust_test(fail_nth_motion fail_nth $<TARGET_FILE:fail_nth> ${SCENE} -64 integrate:malloc)
    shb_robust_test(fail_nth_modal fail_nth $<TARGET_FILE:fail_nth> ${SCENE} 2 modal:malloc)
    set(CONFIGURATION CONFIGURATIONS nightly)
    shb_robust_test(fail_nth_all fail_nth $<TARGET_FILE:fail_nth> ${SCENE})
    unset(CONFIGURATION)
  endif()
endif()
