# Random inputs. Each target is replayed over its seeds and regressions in every build; the test
# fuzz.libfuzzer builds the targets with clang and lets its fuzzer look for new inputs.
set(FUZZ ${CMAKE_CURRENT_SOURCE_DIR}/fuzz)
add_custom_target(fuzzers)
function(shb_fuzz noun)
  add_executable(fuzz_${noun} fuzz/fuzz_${noun}.c fuzz/fuzz_file.c)
  target_link_libraries(fuzz_${noun} PRIVATE ${ARGN} shb_base)
  target_link_options(fuzz_${noun} PRIVATE -Wl,--wrap=fopen)
  target_compile_definitions(fuzz_${noun} PRIVATE
    SHROUDHB_EXAMPLE="${PROJECT_SOURCE_DIR}/cases/z_notch_blade/case.yaml"
    SHROUDHB_SHORT="${FUZZ}/short.yaml")
  add_dependencies(fuzzers fuzz_${noun})
  if(SHROUDHB_FUZZ)
    target_link_options(fuzz_${noun} PRIVATE -fsanitize=fuzzer)
    return()
  endif()
  target_sources(fuzz_${noun} PRIVATE fuzz/replay.c)
  set(inputs ${FUZZ}/seeds/${noun})
  if(EXISTS ${FUZZ}/regressions/${noun})
    list(APPEND inputs ${FUZZ}/regressions/${noun})
  endif()
  shb_add_test(fuzz.${noun} UNIT fuzz_${noun} -runs=200 ${inputs})
endfunction()

shb_fuzz(units shb_case m)
shb_fuzz(case shb_case m)
shb_fuzz(override shb_case m)
shb_fuzz(motion shb_case m)
shb_fuzz(study shb_cases_designs m)
shb_fuzz(inp shb_mesh_io m)
shb_fuzz(msh shb_mesh_io)
shb_fuzz(stamp shb_modal_hdf5 m)
shb_fuzz(table shb_cases_designs shb_mhb_mistuning shb_postproc_draw m)
# without the programs of its room
target_sources(fuzz_table PRIVATE ${PROJECT_SOURCE_DIR}/cases/study/dakota_files.c)
# without PETSc, which its room needs
shb_fuzz(harmonic shb_modal_hdf5)
target_sources(fuzz_harmonic PRIVATE ${PROJECT_SOURCE_DIR}/modal/condense/load_field.c)

shb_shell_test(fuzz.libfuzzer NIGHTLY fuzz/run.sh ${PROJECT_SOURCE_DIR}
  ${CMAKE_CURRENT_BINARY_DIR}/fuzz_clang 8)
