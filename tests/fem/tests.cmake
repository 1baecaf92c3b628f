shb_test(fem/element UNIT finite_strain hourglass material quadrature surface tet10 hex20
  LIBRARIES tests_fem PkgConfig::OPENBLAS)
shb_test(fem/body UNIT assemble clamp_check mass_product rigid_body rotation stress
  INTEGRATION pressure LIBRARIES tests_fem PkgConfig::LAPACKE)
shb_test(fem/supernodal UNIT block_order coarse_order supernodes supernodal_factor
  supernodal_solve lower_blocks condensed_mass unit_loads panel_turns hermitian_factor
  supernodal_hermitian large_pages LIBRARIES tests_fem tests_blocks)
shb_test(fem/solver UNIT hermitian INTEGRATION factor LIBRARIES tests_fem)
