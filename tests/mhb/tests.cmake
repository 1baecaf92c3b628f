# calls of malloc and the like are counted
set(COUNTS_ALLOCATIONS SOURCES support/allocations.c
  LINK LINKER:--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=aligned_alloc)

shb_test(mhb/numerics UNIT block_cyclic extent fourier lu tail thin_product
  LIBRARIES shb_mhb_numerics)
shb_test(mhb/contact UNIT transitions slip slip_onset static_friction slider sensitivity
  dense_output time_history INTEGRATION contact reference_law accuracy continuity random
  LIBRARIES tests_motions)
shb_test(mhb/problem UNIT wave INTEGRATION interfaces parameter LIBRARIES tests_models)
shb_test(mhb/mistuning UNIT deviation_table deviations mistuned_ring LIBRARIES tests_models)
shb_test(mhb/structure UNIT cyclic_flexibility gyroscopic nodal_diameters receptance ring_receptance
  speed_model LIBRARIES tests_models)
shb_test(mhb/low_rank UNIT woodbury gmres LIBRARIES tests_models)
shb_test(mhb/response UNIT publisher response_samples face_wear
  INTEGRATION response modal_motion LIBRARIES tests_models)
# programs without PETSc start faster
shb_test(mhb/response INTEGRATION direct_stress PROGRAM test_mhb_response_modal
  LIBRARIES tests_fem tests_models shb_modal)
shb_test(mhb/balance UNIT balance stick_stiffness newton ring_system subharmonics doubled_ring
  modal_error spatial_error stuck_solver disc_contacts
  INTEGRATION truncation_error truncation_norms coriolis condensation
  LIBRARIES tests_models ${COUNTS_ALLOCATIONS})
shb_test(mhb/search UNIT multistart ring_symmetry ring_motion LIBRARIES tests_models)
shb_test(mhb/floquet UNIT multipliers hill linearised_law ring_band bloch hessenberg_qr
  curve_verdicts INTEGRATION floquet condensed disc_stability mistuned_stability friction_limit
  NIGHTLY monodromy LIBRARIES tests_models ${COUNTS_ALLOCATIONS})
shb_test(mhb/integration UNIT modal_step contact_step contact_path joint_step spectrum
  INTEGRATION integrator integration_memory integration_sweep mistuned_ring bladed_disc amplitudes
  LIBRARIES tests_models)
shb_test(mhb/ring UNIT ring_statistics side_waves slip_flow slow_sweep
  INTEGRATION ring_neimark_sacker neimark_sacker lasting mistuned_lasting ring_step
  LIBRARIES tests_models)
shb_test(mhb/continuation UNIT arclength_scalar balance_curve closed_curve corrector curve
  event_location events linear_corrector nearest_solution outputs
  resonance_detection segment INTEGRATION first_solution arclength linear_resonances
  LIBRARIES tests_models LINK LINKER:--wrap=mhb_arclength_start)
shb_test(mhb/amplification UNIT whitehead INTEGRATION ring_response LIBRARIES tests_models)
shb_test(mhb/branches UNIT free_body branch_completion chain linear_limits main_branch peak_search
  period_doubling record tracer
  INTEGRATION branch_stability forced_response harmonic_selection lasting_motion mistuned_sweep
  multiplier_error run_up secondary_branches ring_search unfinished_curve
  NIGHTLY verdicts LIBRARIES tests_models)
shb_test(mhb/branches INTEGRATION stiff_disc disc_run_up PROGRAM test_mhb_branches_modal
  LIBRARIES tests_fem tests_box tests_models shb_modal shb_mesh_blade)
shb_add_test(mhb.branches.harmonic_selection_all NIGHTLY test_mhb_branches harmonic_selection all)
# it measures its own memory, and PETSc's libraries would be part of it
shb_test(mhb/branches INTEGRATION sweep_memory PROGRAM test_mhb_branches_memory
  LIBRARIES tests_models)
shb_test(mhb/tracking UNIT corner_point kink optimum output_amplitude peak_system
  ring_peaks
  INTEGRATION peak_derivatives corner tracked_curve tracked_multiplier tracked_response
  SLOW corner_pairs
  LIBRARIES tests_models)
