/* A folder of its own for a test's files. */
#ifndef TESTS_SUPPORT_SCRATCH_H
#define TESTS_SUPPORT_SCRATCH_H

#include <stddef.h>

enum { SCRATCH_PATH = 256 };

/* Makes a new folder; fails the test if it cannot. */
void scratch_create(char folder[SCRATCH_PATH]);
/* Write the n bytes of text to folder/name. */
void scratch_write(const char *folder, const char *name, const char *text, size_t n);
/* Removes the folder's files and the folder. */
void scratch_remove(const char *folder);

/* A complete valid case in which the first occurrence of from is replaced by to (NULL: unchanged);
 * malloc'ed. Fails the test if from does not occur. */
char *scratch_case(const char *from, const char *to);

#endif
