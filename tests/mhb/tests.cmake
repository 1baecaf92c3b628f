shb_test(mhb contact fast shb_contact)
shb_test(mhb sweep fast shb_mhb)
target_sources(test_mhb_sweep PRIVATE mhb/three_degree.c)
shb_test(mhb response fast shb_response)
