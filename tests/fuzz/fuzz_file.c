#include "tests/fuzz/fuzz_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mesh/base/status.h"

enum { PATH_ROOM = 512, MOST_FILES = 4 };

/* For the address sanitizer: freed memory is kept for the inputs of some milliseconds, not
 * seconds, and stays in the cache. Places of allocation are not kept. They are shown for an input
 * with ASAN_OPTIONS=malloc_context_size=30. */
const char *__asan_default_options(void);
const char *__asan_default_options(void) {
  return "quarantine_size_mb=4:thread_local_quarantine_size_kb=256:max_malloc_fill_size=256:"
         "malloc_context_size=0";
}

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

/* A file of the folder, kept open: a target writes one or two. */
static struct {
  const char *name;
  int         file;
  char        path[PATH_ROOM];
} kept[MOST_FILES];

static int place_of(const char *name) {
  int i = 0;
  while (i < MOST_FILES && kept[i].name && strcmp(kept[i].name, name) != 0) i++;
  fuzz_assert(i < MOST_FILES, "too many files");
  if (kept[i].name) return i;
  if (!folder[0]) make_folder();
  kept[i].name = name;
  snprintf(kept[i].path, sizeof kept[i].path, "%s/%s", folder, name);
  kept[i].file = open(kept[i].path, O_RDWR | O_CREAT | O_TRUNC, 0600);
  return i;
}

const char *fuzz_file(const char *name, const void *data, size_t size) {
  int i = place_of(name);
  fuzz_assert(kept[i].file >= 0 && ftruncate(kept[i].file, (off_t)size) == 0 &&
                  pwrite(kept[i].file, data, size, 0) == (ssize_t)size,
              "the input cannot be written");
  return kept[i].path;
}

/* Texts that fopen reads; the linker replaces it. Calls of the system took a tenth of the time. */
static struct {
  const char *path;
  const void *data;
  size_t      size;
} kept_text[MOST_FILES];

const char *fuzz_text(const char *path, const void *data, size_t size) {
  int i = 0;
  while (i < MOST_FILES && kept_text[i].path && kept_text[i].path != path) i++;
  fuzz_assert(i < MOST_FILES, "too many texts");
  kept_text[i].path = path;
  kept_text[i].data = data;
  kept_text[i].size = size;
  return path;
}

/* A file, read once. */
typedef struct {
  char   text[FUZZ_MOST];
  size_t length;
} whole_file;

static void load(const char *path, whole_file *out) {
  FILE *file = out->length ? NULL : fopen(path, "rb");
  if (file) out->length = fread(out->text, 1, sizeof out->text, file);
  if (file) fclose(file);
  fuzz_assert(out->length > 0, path);
}

/* A case without a mesh. It is read twice as fast as the short one. */
static const char NO_MESH[] = "modal: {file: " SHROUDHB_EXAMPLE
                              "}\n"
                              "rotor: {blades: 40}\n"
                              "excitation: {engine_order: 5}\n"
                              "contact: {to: neighbour, mu: 0.3, ku: 5e5, kv: 8e5, n0: 50}\n"
                              "mhb: {frequency: [90, 270]}\n";

const char *fuzz_case(const char *path, size_t size) {
  static whole_file example, brief;
  if (size % 32 > 3) return fuzz_text(path, NO_MESH, sizeof NO_MESH - 1);
  whole_file *chosen = size % 32 == 0 ? &example : &brief;
  load(chosen == &example ? SHROUDHB_EXAMPLE : SHROUDHB_SHORT, chosen);
  return fuzz_text(path, chosen->text, chosen->length);
}

FILE *__real_fopen(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode) {
  for (int i = 0; i < MOST_FILES && kept_text[i].path; i++)
    if (strcmp(path, kept_text[i].path) == 0)
      return fmemopen((void *)kept_text[i].data, kept_text[i].size, mode);
  return __real_fopen(path, mode);
}

static FILE  *messages;
static char  *message;
static size_t message_size;

FILE *fuzz_messages(void) {
  if (!messages) messages = open_memstream(&message, &message_size);
  fuzz_assert(messages && fseek(messages, 0, SEEK_SET) == 0, "no memory for messages");
  return messages;
}

/* C0 but for tabs and ends of lines, DEL, and C1 in UTF-8. */
static int is_control(const unsigned char *c) {
  return (c[0] < 0x20 && c[0] != '\n' && c[0] != '\t') || c[0] == 0x7f ||
         (c[0] == 0xc2 && c[1] >= 0x80 && c[1] < 0xa0);
}

void fuzz_messages_end(int refused) {
  fuzz_assert(fflush(messages) == 0, "no memory for messages");
  fuzz_assert(!refused || message_size > 0 || shb_message()[0], "refused without a word");
  for (size_t i = 0; i < message_size; i++)
    fuzz_assert(!is_control((unsigned char *)message + i), "a control character in a message");
}

void fuzz_assert(int holds, const char *text) {
  if (holds) return;
  fprintf(stderr, "fuzz: %s\n", text);
  abort();
}
