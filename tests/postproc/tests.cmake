add_library(post_fixture STATIC postproc/fixture.c)
target_link_libraries(post_fixture PUBLIC shb_post)

shb_test(postproc unit fast shb_post)
shb_test(postproc buffer fast shb_post)
shb_test(postproc plot fast shb_post)
shb_test(postproc output fast shb_post)
shb_test(postproc abscissa fast post_fixture)
shb_test(postproc curves fast post_fixture)
shb_test(postproc distance fast shb_post)
shb_test(postproc convergence fast shb_post)
shb_test(postproc study fast post_fixture)
shb_test(postproc csv fast post_fixture)
shb_test(postproc report fast post_fixture)
shb_test(postproc inspect fast post_fixture)
shb_test(postproc publish fast post_fixture)

# The program itself: exit codes and the one line of an error.
if(TARGET shroudhb-post)
  shb_test(postproc command fast post_fixture)
  add_dependencies(test_postproc_command shroudhb-post)
  set_tests_properties(postproc.command PROPERTIES ENVIRONMENT
    "SHROUDHB_POST=$<TARGET_FILE:shroudhb-post>")
endif()
