shb_test(mhb contact fast shb_contact)
