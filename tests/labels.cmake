# Labels and timeouts of all tests, by the CPU time that tests/house/cpu_times.py measures:
#
#   unit         below 1 s of CPU time, and below 20 s together; every test that is not listed here
#   integration  below 20 s each
#   slow         above
#   nightly      hours; only `ctest -C nightly -L nightly` runs them
#
# The timeouts are ten times these times and more, because a busy machine runs a test slower.
# A unit test that outgrows its label therefore fails at last.
set(INTEGRATION_TESTS cases.study.study cases.study.samples cases.study.eval
  cases.study.blade_study
  cases.peaks.design_run cases.field.field cases.commands.json cases.commands.revision
  cases.scenes.read_results
  mesh.io.source mesh.blade.hex_sweep mesh.blade.command fem.solver.factor modal.hdf5.h5
  modal.stage.coriolis mhb.floquet.disc_stability mhb.balance.coriolis
  modal.common.completeness modal.eigen.eigen modal.condense.condense modal.stage.ranks_1
  modal.stage.ranks_2 modal.stage.ranks_3 modal.cyclic.calculix modal.stage.sector
  mesh.blade.disc modal.cyclic.wave_modes modal.cyclic.blade_on_disc mhb.branches.disc_run_up
  mhb.branches.stiff_disc
  modal.stage.calculix mhb.contact.contact
  mhb.contact.reference_law mhb.contact.accuracy mhb.contact.continuity mhb.contact.random
  mhb.problem.interfaces mhb.problem.parameter
  mhb.response.modal_motion
  mhb.response.direct_stress mhb.response.response mhb.balance.condensation
  mhb.balance.truncation_error mhb.floquet.condensed mhb.floquet.floquet
  mhb.floquet.mistuned_stability
  cases.study.ring_samples
  mhb.integration.integrator
  mhb.integration.integration_sweep mhb.integration.integration_memory mhb.integration.mistuned_ring
  mhb.integration.bladed_disc mhb.integration.amplitudes postproc.report.blade_view
  mhb.amplification.ring_response bench.mistuning mhb.ring.lasting mhb.ring.mistuned_lasting
  mhb.branches.lasting_motion
  mhb.continuation.arclength mhb.continuation.linear_resonances
  mhb.branches.harmonic_selection mhb.branches.branch_stability mhb.branches.secondary_branches
  mhb.branches.ring_search mhb.branches.unfinished_curve mhb.branches.sweep_memory
  mhb.branches.forced_response mhb.branches.run_up postproc.report.report cases.commands.integrate
  cases.scenes.z_notch cases.scenes.slip_onset cases.scenes.run_up cases.scenes.paper_fig7
  cases.scenes.paper_fig8 cases.scenes.paper_fig9 cases.scenes.paper_fig10
  cases.scenes.paper_fig8_direct cases.scenes.lost_curves cases.scenes.snubber_blade
  hard.three_degree hard.jumps hard.ends hard.friction hard.resonance hard.balance hard.pairs
  hard.peaks hard.isolas hard.parameters bench.stability bench.modal bench.contact
  bench.integrate bench.lasting bench.residuals bench.study bench.study_rates
  mhb.floquet.friction_limit
  docs.first_case
  mhb.ring.ring_step mhb.ring.neimark_sacker cases.install.install
  mhb.tracking.corner mhb.tracking.tracked_curve
  mhb.tracking.tracked_multiplier mhb.branches.mistuned_sweep bench.tracking
  robust.same_bits robust.not_finite robust.fail_nth_integrate robust.fail_nth_study
  robust.fail_nth_mesh mesh.blade.shroud_angle cases.converge.points_ladder
  robust.memory robust.numbers
  cases.commands.contact_points modal.hdf5.stamp)
if(SHROUDHB_CHROMIUM AND SHROUDHB_PYTHON)
  list(APPEND INTEGRATION_TESTS postproc.study.page_script postproc.report.page_script)
endif()
set(SLOW_TESTS
  cases.scenes.mistuned_ring cases.scenes.bladed_disc cases.scenes.disc_vary
  mesh.blade.blade mhb.floquet.monodromy mhb.branches.verdicts cases.converge.converge hard.gaps
  hard.oblique
  bench.elements cases.scenes.optimum_preload cases.scenes.tracked_peaks
  mhb.tracking.corner_pairs
  fuzz.libfuzzer mhb.tracking.tracked_response
  robust.fail_nth robust.fail_nth_motion robust.kills robust.kills_ring
  robust.damaged robust.surroundings)

set(NIGHTLY_TESTS robust.fail_nth_all robust.numbers_all robust.kills_many
  robust.kills_ring_many robust.damaged_many robust.sanitizers)

if(TARGET repeated_sweep)
  list(APPEND INTEGRATION_TESTS robust.repeated)
  list(APPEND NIGHTLY_TESTS robust.repeated_many)
endif()

set(TIMEOUT_nightly 86400)
set(TIMEOUT_unit 100)
set(TIMEOUT_integration 600)
set(TIMEOUT_slow 900)
# no optimisation, or every access checked
if(SHROUDHB_SANITIZE OR SHROUDHB_TSAN OR CMAKE_BUILD_TYPE STREQUAL "Debug")
  foreach(label unit integration slow)
    math(EXPR TIMEOUT_${label} "10 * ${TIMEOUT_${label}}")
  endforeach()
endif()

if(SHROUDHB_TSAN)
  list(APPEND SLOW_TESTS robust.threads)
endif()
if(TARGET shroudhb-study)
  list(APPEND SLOW_TESTS cases.scenes.shroud_angle cases.scenes.robust_preload)
  list(APPEND INTEGRATION_TESTS cases.scenes.soft_contact)
endif()

get_property(all_tests DIRECTORY PROPERTY TESTS)
foreach(name ${INTEGRATION_TESTS} ${SLOW_TESTS} ${NIGHTLY_TESTS})
  if(SHROUDHB_PYTHON AND NOT name IN_LIST all_tests)
    message(WARNING "tests/labels.cmake: there is no test ${name}")
  endif()
endforeach()
foreach(name ${all_tests})
  set(label unit)
  if(name IN_LIST INTEGRATION_TESTS)
    set(label integration)
  elseif(name IN_LIST SLOW_TESTS)
    set(label slow)
  elseif(name IN_LIST NIGHTLY_TESTS)
    set(label nightly)
  endif()
  set_tests_properties(${name} PROPERTIES LABELS ${label} TIMEOUT ${TIMEOUT_${label}})
endforeach()
