/* A library for LD_PRELOAD: the n-th call of one function fails, as on a full disk or without
 * memory. tests/robust/test_fail_nth.py drives it by three variables of the environment:
 *
 *   FAIL_CALL   malloc, open, write, fsync, rename, close, thread, or the name of an H5 function
 *   FAIL_NTH    which call fails, from 1; 0: none
 *   FAIL_COUNT  file that receives the number of calls at the end of the process
 *
 * Calls of malloc count where the program itself makes them; those of its libraries pass.
 * Calls of write count for files only, so that messages reach the terminal.
 */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <link.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *chosen; /* NULL before the start */
static long        nth;
static atomic_long calls;
static uintptr_t   program_begin, program_end; /* code of the program itself */

static int code_of_program(struct dl_phdr_info *object, size_t size, void *data) {
  (void)size;
  (void)data;
  for (int i = 0; i < object->dlpi_phnum; i++) {
    const ElfW(Phdr) *part = &object->dlpi_phdr[i];
    if (part->p_type != PT_LOAD || !(part->p_flags & PF_X)) continue;
    program_begin = object->dlpi_addr + part->p_vaddr;
    program_end   = program_begin + part->p_memsz;
  }
  return 1; /* the first object is the program */
}

__attribute__((constructor)) static void start(void) {
  const char *text = getenv("FAIL_NTH");
  nth              = text ? strtol(text, NULL, 10) : 0;
  dl_iterate_phdr(code_of_program, NULL);
  chosen = getenv("FAIL_CALL");
}

__attribute__((destructor)) static void finish(void) {
  const char *name = getenv("FAIL_COUNT");
  char        text[32];
  chosen = NULL;
  if (!name) return;
  const int length = snprintf(text, sizeof text, "%ld\n", atomic_load(&calls));
  const int file   = open(name, O_WRONLY | O_CREAT | O_APPEND, 0600);
  if (file < 0) return;
  if (write(file, text, (size_t)length) != length) abort();
  close(file);
}

/* Counts a call of the function of that name; 1 if it is to fail. */
static int fails(const char *name) {
  if (!chosen || strcmp(chosen, name) != 0) return 0;
  return atomic_fetch_add(&calls, 1) + 1 == nth;
}

static int is_file(int fd) {
  struct stat about;
  return chosen && fstat(fd, &about) == 0 && S_ISREG(about.st_mode);
}

/* The function that this library hides. ISO C has no cast from object to function pointer. */
#define HIDDEN(type, name)                         \
  __typeof__(type) hidden;                         \
  void            *found = dlsym(RTLD_NEXT, name); \
  memcpy(&hidden, &found, sizeof found)

#define FAIL(name, error, value) \
  do {                           \
    if (fails(name)) {           \
      errno = error;             \
      return value;              \
    }                            \
  } while (0)

#define OWN_CALL                                              \
  ((uintptr_t)__builtin_return_address(0) >= program_begin && \
   (uintptr_t)__builtin_return_address(0) < program_end)

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);

void *malloc(size_t size) {
  if (OWN_CALL) FAIL("malloc", ENOMEM, NULL);
  return __libc_malloc(size);
}

void *calloc(size_t count, size_t size) {
  if (OWN_CALL) FAIL("malloc", ENOMEM, NULL);
  return __libc_calloc(count, size);
}

void *realloc(void *old, size_t size) {
  if (OWN_CALL) FAIL("malloc", ENOMEM, NULL);
  return __libc_realloc(old, size);
}

void *__libc_memalign(size_t alignment, size_t size);

void *aligned_alloc(size_t alignment, size_t size) {
  if (OWN_CALL) FAIL("malloc", ENOMEM, NULL);
  return __libc_memalign(alignment, size);
}

static int opened(const char *name, const char *path, int flags, mode_t mode) {
  FAIL("open", EMFILE, -1);
  HIDDEN(int (*)(const char *, int, ...), name);
  return hidden(path, flags, mode);
}

#define OPEN(name)                             \
  int name(const char *path, int flags, ...) { \
    mode_t mode = 0;                           \
    if (flags & O_CREAT) {                     \
      va_list more;                            \
      va_start(more, flags);                   \
      mode = va_arg(more, mode_t);             \
      va_end(more);                            \
    }                                          \
    return opened(#name, path, flags, mode);   \
  }
OPEN(open)
OPEN(open64)

#define FOPEN(name)                                       \
  FILE *name(const char *path, const char *mode) {        \
    FAIL("open", EMFILE, NULL);                           \
    HIDDEN(FILE *(*)(const char *, const char *), #name); \
    return hidden(path, mode);                            \
  }
FOPEN(fopen)
FOPEN(fopen64)

ssize_t write(int fd, const void *data, size_t size) {
  if (is_file(fd)) FAIL("write", ENOSPC, -1);
  HIDDEN(ssize_t(*)(int, const void *, size_t), "write");
  return hidden(fd, data, size);
}

#define PWRITE(name, offset)                                       \
  ssize_t name(int fd, const void *data, size_t size, offset at) { \
    if (is_file(fd)) FAIL("write", ENOSPC, -1);                    \
    HIDDEN(ssize_t (*)(int, const void *, size_t, offset), #name); \
    return hidden(fd, data, size, at);                             \
  }
PWRITE(pwrite, off_t)
PWRITE(pwrite64, off64_t)

/* What a stream still holds is lost, as on a full disk. */
int fclose(FILE *file) {
  HIDDEN(int (*)(FILE *), "fclose");
  if (fails("close")) {
    hidden(file);
    errno = ENOSPC;
    return EOF;
  }
  return hidden(file);
}

int fflush(FILE *file) {
  if (file != stderr && file != stdout) FAIL("close", ENOSPC, EOF);
  HIDDEN(int (*)(FILE *), "fflush");
  return hidden(file);
}

int fsync(int fd) {
  FAIL("fsync", EIO, -1);
  HIDDEN(int (*)(int), "fsync");
  return hidden(fd);
}

int rename(const char *from, const char *to) {
  FAIL("rename", EROFS, -1);
  HIDDEN(int (*)(const char *, const char *), "rename");
  return hidden(from, to);
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*body)(void *),
                   void *data) {
  if (fails("thread")) return EAGAIN;
  HIDDEN(int (*)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *), "pthread_create");
  return hidden(thread, attributes, body, data);
}

/* H5(result, name, parameters, arguments): a call of HDF5 that fails with -1 */
#define H5(result, name, parameters, arguments) \
  result name parameters {                      \
    if (fails(#name)) return -1;                \
    HIDDEN(result(*) parameters, #name);        \
    return hidden arguments;                    \
  }
H5(hid_t, H5Fcreate, (const char *path, unsigned flags, hid_t create, hid_t access),
   (path, flags, create, access))
H5(hid_t, H5Fopen, (const char *path, unsigned flags, hid_t access), (path, flags, access))
H5(herr_t, H5Fclose, (hid_t file), (file))
H5(hid_t, H5Gcreate2, (hid_t at, const char *name, hid_t link, hid_t create, hid_t access),
   (at, name, link, create, access))
H5(hid_t, H5Gopen2, (hid_t at, const char *name, hid_t access), (at, name, access))
H5(hid_t, H5Dcreate2,
   (hid_t at, const char *name, hid_t type, hid_t space, hid_t link, hid_t create, hid_t access),
   (at, name, type, space, link, create, access))
H5(hid_t, H5Dopen2, (hid_t at, const char *name, hid_t access), (at, name, access))
H5(herr_t, H5Dwrite,
   (hid_t set, hid_t memory, hid_t from, hid_t to, hid_t transfer, const void *data),
   (set, memory, from, to, transfer, data))
H5(herr_t, H5Dread, (hid_t set, hid_t memory, hid_t from, hid_t to, hid_t transfer, void *data),
   (set, memory, from, to, transfer, data))
H5(herr_t, H5Dclose, (hid_t set), (set))
H5(hid_t, H5Screate_simple, (int rank, const hsize_t *extent, const hsize_t *most),
   (rank, extent, most))
H5(herr_t, H5Awrite, (hid_t attribute, hid_t type, const void *data), (attribute, type, data))
H5(herr_t, H5Aread, (hid_t attribute, hid_t type, void *data), (attribute, type, data))
