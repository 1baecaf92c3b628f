/* Work in a process with little memory, for what must be refused there. */
#ifndef TESTS_SUPPORT_LITTLE_MEMORY_H
#define TESTS_SUPPORT_LITTLE_MEMORY_H

/* Run the work in a child process. Fails the test unless it ends with success. */
void little_memory_run(void (*work)(void));

/* Limit the address space of this process until at least `wanted` bytes are left, and hardly more.
 * Returns the bytes left. */
double little_memory_limit(double wanted);

/* The number behind a key of the last message. Fails the test if the message lacks the key. */
int little_memory_number(const char *key);

#endif
