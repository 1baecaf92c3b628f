# What holds for the sources themselves. Each check has a self-test: made-up faults must be found.
shb_python_test(tests.rooms_are_acyclic UNIT house/test_rooms.py ${PROJECT_SOURCE_DIR})
shb_python_test(tests.rooms_check_finds_faults UNIT house/test_rooms.py --self-test)

# No line above 100 columns, no sentence of a comment above 25 words.
shb_python_test(tests.width UNIT house/test_text.py width ${PROJECT_SOURCE_DIR})
shb_python_test(tests.sentences UNIT house/test_text.py sentences ${PROJECT_SOURCE_DIR})
shb_python_test(tests.text_checks_find_faults UNIT house/test_text.py --self-test)
