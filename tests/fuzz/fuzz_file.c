#include "tests/fuzz/fuzz_file.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mesh/base/status.h"

enum { PATH_ROOM = 512 };

static char folder[PATH_ROOM / 2];

static void remove_folder(void) {
  DIR *files = opendir(folder);
  for (struct dirent *entry; files && (entry = readdir(files));) {
    char path[PATH_ROOM];
    snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
    unlink(path);
  }
  if (files) closedir(files);
  rmdir(folder);
}

static void make_folder(void) {
  const char *parent = getenv("TMPDIR");
  snprintf(folder, sizeof folder, "%s/shroudhb_fuzz_XXXXXX", parent ? parent : "/tmp");
  fuzz_assert(mkdtemp(folder) != NULL, "no folder for the inputs");
  atexit(remove_folder);
}

const char *fuzz_file(const char *name, const void *data, size_t size) {
  static char path[PATH_ROOM];
  if (!folder[0]) make_folder();
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "wb");
  fuzz_assert(file && fwrite(data, 1, size, file) == size && fclose(file) == 0,
              "the input cannot be written");
  return path;
}

static FILE  *messages;
static char  *message;
static size_t message_size;

FILE *fuzz_messages(void) {
  messages = open_memstream(&message, &message_size);
  fuzz_assert(messages != NULL, "no memory for messages");
  return messages;
}

/* C0 but for tabs and ends of lines, DEL, and C1 in UTF-8. */
static int is_control(const unsigned char *c) {
  return (c[0] < 0x20 && c[0] != '\n' && c[0] != '\t') || c[0] == 0x7f ||
         (c[0] == 0xc2 && c[1] >= 0x80 && c[1] < 0xa0);
}

void fuzz_messages_end(int refused) {
  fuzz_assert(fclose(messages) == 0, "no memory for messages");
  fuzz_assert(!refused || message_size > 0 || shb_message()[0], "refused without a word");
  for (size_t i = 0; i < message_size; i++)
    fuzz_assert(!is_control((unsigned char *)message + i), "a control character in a message");
  free(message);
  message = NULL;
}

void fuzz_assert(int holds, const char *text) {
  if (holds) return;
  fprintf(stderr, "fuzz: %s\n", text);
  abort();
}
