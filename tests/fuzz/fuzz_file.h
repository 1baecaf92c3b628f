/* Bytes of a fuzzer as a file that the program opens by its path. */
#ifndef TESTS_FUZZ_FUZZ_FILE_H
#define TESTS_FUZZ_FUZZ_FILE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* The entry of libFuzzer, which every target defines. Returns 0. A fault ends the process. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Where a target wants more than single bytes of its input. */
enum { FUZZ_MOST = 1 << 16 };

/* Write the bytes to the file of that name in a folder of this process, and return its path. The
 * name is a literal. The folder is removed at the end of the process. */
const char *fuzz_file(const char *name, const void *data, size_t size);

/* The same without a file: whoever opens the path by fopen reads the bytes. Both are borrowed, and
 * the path is a literal. */
const char *fuzz_text(const char *path, const void *data, size_t size);

/* A case of that path beside an input: without a mesh, or for three lengths in 32 a short one, or
 * for one the example. The first is read twice as fast as the second, six times as fast as the
 * third. The path is a literal, and is returned. */
const char *fuzz_case(const char *path, size_t size);

/* Begin a stream for messages. */
FILE *fuzz_messages(void);

/* End it: no message may hold a control character, and a refusal has at least one line. */
void fuzz_messages_end(int refused);

/* End the process with the text, unless the condition holds. */
void fuzz_assert(int holds, const char *text);

#endif
