# What holds for the sources themselves. Each check has a self-test: made-up faults must be found.
# shb_house_test(name script arguments...): runs house/script with python3 (standard library only).
function(shb_house_test name script)
  add_test(NAME tests.${name} COMMAND ${SHROUDHB_PYTHON} -B
    ${CMAKE_CURRENT_SOURCE_DIR}/house/${script} ${ARGN})
endfunction()

shb_house_test(rooms_are_acyclic test_rooms.py ${PROJECT_SOURCE_DIR})
shb_house_test(rooms_check_finds_faults test_rooms.py --self-test)

# No line above 100 columns, no sentence of a comment above 25 words.
shb_house_test(width test_text.py width ${PROJECT_SOURCE_DIR})
shb_house_test(sentences test_text.py sentences ${PROJECT_SOURCE_DIR})
shb_house_test(text_checks_find_faults test_text.py --self-test)
