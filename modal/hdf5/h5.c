#include "modal/hdf5/h5.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "mesh/base/crash_guard.h"
#include "mesh/process/child.h"
#include "modal/hdf5/h5_internal.h"
#include "modal/hdf5/stamp.h"

/* HDF5's core driver builds a file in memory, without backing store. h5_close writes it with
 * write(). HDF5 1.10 leaves a file open whose flush failed, and may crash at exit on a full
 * disk. */
enum { GROWTH = 1 << 20 };

/* CPU time of the trial of a file: so many seconds, and one more for so many bytes. A sound file
 * takes some milliseconds. */
enum { TRIAL = 1, TRIAL_BYTES = 10000000 };

size_t h5_count(h5_shape shape) {
  size_t count = 1;
  for (int i = 0; i < shape.rank; i++) count *= (size_t)shape.dim[i];
  return count;
}

static herr_t innermost(unsigned n, const H5E_error2_t *error, void *out) {
  (void)n;
  snprintf(out, H5_LABEL, "%s", error->desc ? error->desc : "");
  return 1; /* the walk starts at the cause and ends here */
}

void h5_reason(char *out, size_t size) {
  char text[H5_LABEL] = "";
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, innermost, text);
  snprintf(out, size, "%s", *text ? text : "unknown HDF5 error");
}

/* Messages name the published file. */
static void cut_temporary(char *path) {
  size_t length;
  if (shb_publish_owner(path, &length)) path[length] = '\0';
}

const char *h5_label(hid_t at, const char *path, char out[H5_LABEL]) {
  char file[H5_LABEL] = "", group[H5_LABEL] = "";
  if (H5Fget_name(at, file, sizeof file) < 0) *file = '\0';
  if (H5Iget_name(at, group, sizeof group) < 0) *group = '\0';
  cut_temporary(file);
  size_t end = strlen(group);
  while (end && group[end - 1] == '/') group[--end] = '\0';
  int n;
  if (*path == '/' || strcmp(path, ".") == 0) {
    n = snprintf(out, H5_LABEL, "%s: %s", file, *path == '/' ? path : *group ? group : "/");
  } else {
    n = snprintf(out, H5_LABEL, "%s: %s/%s", file, group, path);
  }
  if (n >= H5_LABEL) memcpy(out + H5_LABEL - 4, "...", 4);
  return out;
}

shb_status h5_failed(shb_status code, hid_t at, const char *path, const char *verb) {
  char label[H5_LABEL], reason[H5_LABEL];
  h5_reason(reason, sizeof reason);
  h5_label(at, path, label);
  SHB_FAIL(code, "%s %s: %s", label, verb, reason);
}

const char *h5_shape_text(h5_shape shape, bool wanted, char out[128]) {
  size_t n = 0;
  out[n++] = '[';
  for (int i = 0; i < shape.rank; i++) {
    const char *comma = i ? ", " : "";
    if (wanted && shape.dim[i] == 0) {
      n += (size_t)snprintf(out + n, 128 - n, "%sany", comma);
    } else {
      n += (size_t)snprintf(out + n, 128 - n, "%s%llu", comma, (unsigned long long)shape.dim[i]);
    }
  }
  snprintf(out + n, 128 - n, "]");
  return out;
}

shb_status h5_check_finite(const char *label, h5_shape shape, const double *data, size_t per,
                           const char *rule) {
  size_t count = h5_count(shape) * per, bad = 0;
  while (bad < count && isfinite(data[bad])) bad++;
  if (bad == count) return SHB_OK;
  h5_shape at   = shape;
  size_t   rest = bad / per;
  for (int i = shape.rank - 1; i >= 0; i--) {
    at.dim[i] = rest % shape.dim[i];
    rest /= shape.dim[i];
  }
  char index[128];
  SHB_FAIL(SHB_ERR_INPUT, "%s: the value at %s (from 0) is %s; %s", label,
           h5_shape_text(at, false, index), isnan(data[bad]) ? "not a number" : "infinite", rule);
}

hid_t h5_complex_type(const char *real, const char *imaginary) {
  hid_t type = H5Tcreate(H5T_COMPOUND, 2 * sizeof(double));
  if (type < 0) return type;
  if (H5Tinsert(type, real, 0, H5T_NATIVE_DOUBLE) < 0 ||
      H5Tinsert(type, imaginary, sizeof(double), H5T_NATIVE_DOUBLE) < 0) {
    H5Tclose(type);
    return -1;
  }
  return type;
}

hid_t h5_text_type(void) {
  hid_t type = H5Tcopy(H5T_C_S1);
  if (type < 0) return type;
  if (H5Tset_size(type, H5T_VARIABLE) < 0 || H5Tset_cset(type, H5T_CSET_UTF8) < 0) {
    H5Tclose(type);
    return -1;
  }
  return type;
}

/* Closing the file closes every object left open in it. Files have the format of HDF5 1.8. Earlier
 * formats limit an attribute to 64 kB, thus a dimension scale to 4085 datasets. */
static hid_t access_list(bool in_memory) {
  hid_t list = H5Pcreate(H5P_FILE_ACCESS);
  if (list < 0) return list;
  if (H5Pset_fclose_degree(list, H5F_CLOSE_STRONG) < 0 ||
      (in_memory && (H5Pset_fapl_core(list, GROWTH, 0) < 0 ||
                     H5Pset_libver_bounds(list, H5F_LIBVER_V18, H5F_LIBVER_V18) < 0))) {
    H5Pclose(list);
    return -1;
  }
  return list;
}

/* Remove a regular file only, never a device such as /dev/null. */
static void remove_file(const char *path) {
  struct stat info;
  if (lstat(path, &info) == 0 && S_ISREG(info.st_mode)) unlink(path);
}

static shb_status write_failed(const char *path, int why) {
  char name[4096];
  snprintf(name, sizeof name, "%s", path);
  cut_temporary(name);
  SHB_FAIL(SHB_ERR_IO, "%s: cannot be written: %s; the earlier file, if any, is untouched", name,
           strerror(why));
}

/* A missing folder is reported before the computation. */
static shb_status make_empty(const char *path) {
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (fd < 0) return write_failed(path, errno);
  close(fd);
  return SHB_OK;
}

/* Of a file that HDF5 could not create. */
static shb_status create_failed(const char *path) {
  char reason[H5_LABEL];
  h5_reason(reason, sizeof reason);
  remove_file(path);
  SHB_FAIL(SHB_ERR_IO, "%s: cannot be created: %s", path, reason);
}

shb_status h5_create(const char *path, hid_t *file) {
  *file = H5I_INVALID_HID;
  SHB_TRY(make_empty(path));
  hid_t list = access_list(true);
  if (list >= 0) *file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, list);
  shb_status status = *file < 0 ? create_failed(path) : SHB_OK;
  if (list >= 0) H5Pclose(list);
  return status;
}

/* The bytes behind the stamp, malloc'ed. */
static shb_status read_image(const char *path, char **image, size_t *size) {
  *image     = NULL;
  *size      = 0;
  FILE *file = fopen(path, "rb");
  SHB_CHECK(file, SHB_ERR_IO, "%s: cannot be opened: %s", path, strerror(errno));
  const bool known = fseek(file, 0, SEEK_END) == 0;
  const long end   = known ? ftell(file) : -1;
  *size            = end > H5_STAMP ? (size_t)(end - H5_STAMP) : 0;
  *image           = malloc(*size + 1);
  const bool whole = *image && *size > 0 && fseek(file, H5_STAMP, SEEK_SET) == 0 &&
                     fread(*image, 1, *size, file) == *size;
  fclose(file);
  SHB_CHECK(whole, SHB_ERR_IO, "%s: cannot be read", path);
  return SHB_OK;
}

/* HDF5 copies the image, and refuses a path where a file is. */
static shb_status create_from(const char *path, char *image, size_t size, hid_t *file) {
  SHB_TRY(make_empty(path));
  remove_file(path);
  hid_t list = access_list(true);
  if (list >= 0 && H5Pset_file_image(list, image, size) >= 0)
    *file = H5Fopen(path, H5F_ACC_RDWR, list);
  shb_status status = *file < 0 ? create_failed(path) : h5_check_content(path, *file);
  if (list >= 0) H5Pclose(list);
  if (status != SHB_OK && *file >= 0) {
    H5Fclose(*file);
    *file = H5I_INVALID_HID;
  }
  return status;
}

shb_status h5_create_like(const char *earlier, const char *path, hid_t *file) {
  *file                      = H5I_INVALID_HID;
  const h5_stamp_state stamp = h5_stamp_check(earlier);
  SHB_CHECK(stamp != H5_UNREADABLE, SHB_ERR_IO, "%s: cannot be read: %s", earlier, strerror(errno));
  SHB_CHECK(stamp == H5_INTACT, SHB_ERR_INPUT,
            "%s: was changed since it was written, or by another program", earlier);
  char      *image;
  size_t     size;
  shb_status status = read_image(earlier, &image, &size);
  if (status == SHB_OK) status = create_from(path, image, size, file);
  free(image);
  return status;
}

/* HDF5 reports a short file either as truncated or as one without a superblock. */
static shb_status open_failed(const char *path) {
  char reason[H5_LABEL];
  h5_reason(reason, sizeof reason);
  if (strstr(reason, "truncated"))
    SHB_FAIL(SHB_ERR_IO, "%s: is truncated (%s); write or copy it again", path, reason);
  if (strstr(reason, "unable to open file: name")) /* the system refuses, not the content */
    SHB_FAIL(SHB_ERR_IO, "%s: cannot be opened (%s)", path, reason);
  if (strstr(reason, "lock"))
    SHB_FAIL(SHB_ERR_IO, "%s: is locked, another program has it open for writing", path);
  SHB_FAIL(SHB_ERR_IO, "%s: is damaged or truncated (%s); write or copy it again", path, reason);
}

static shb_status check_readable(const char *path) {
  struct stat info;
  int         fd = open(path, O_RDONLY | O_NONBLOCK); /* opening a pipe would wait for its writer */
  SHB_CHECK(fd >= 0, SHB_ERR_IO, "%s: cannot be opened: %s", path, strerror(errno));
  bool known = fstat(fd, &info) == 0;
  close(fd);
  SHB_CHECK(known && S_ISREG(info.st_mode), SHB_ERR_IO, "%s: is not a file", path);
  SHB_CHECK(info.st_size > 0, SHB_ERR_IO, "%s: is empty, not an HDF5 file", path);
  const htri_t is_hdf5 = H5Fis_hdf5(path); /* negative: it cannot be opened */
  SHB_CHECK(is_hdf5 >= 0, SHB_ERR_IO, "%s: cannot be opened by HDF5", path);
  SHB_CHECK(is_hdf5 > 0, SHB_ERR_IO, "%s: is not an HDF5 file", path);
  return SHB_OK;
}

/* Number of files open for reading; the guard is up while there are some. */
static int n_reading;

static void start_reading(const char *path) {
  n_reading++;
  shb_guard_begin(path, "is damaged: HDF5 crashed while it was read; write or copy it again",
                  false);
}

static void stop_reading(void) {
  if (n_reading > 0 && --n_reading == 0) shb_guard_end();
}

/* A file whose stamp does not fit is told once. */
static void warn_changed(const char *path) {
  static char told[H5_LABEL];
  if (strcmp(path, told) == 0) return;
  snprintf(told, sizeof told, "%s", path);
  fprintf(
      stderr,
      "shroudhb: warning: %s: its checksum does not fit: it was changed or damaged since it was "
      "written\n",
      path);
}

/* Open for reading, under the guard. */
static shb_status open_guarded(const char *path, hid_t *file) {
  hid_t list = access_list(false);
  SHB_CHECK(list >= 0, SHB_ERR_IO, "%s: cannot be opened: HDF5 failed to start", path);
  start_reading(path);
  *file             = H5Fopen(path, H5F_ACC_RDONLY, list);
  shb_status status = *file < 0 ? open_failed(path) : h5_check_content(path, *file);
  H5Pclose(list);
  if (status == SHB_OK) return SHB_OK;
  if (*file >= 0) H5Fclose(*file);
  *file = H5I_INVALID_HID;
  stop_reading();
  return status;
}

/* Read all texts of a file that may crash HDF5: attributes, and datasets of strings. */
static herr_t read_attribute(hid_t object, const char *name, const H5A_info_t *info, void *unused) {
  (void)info;
  (void)unused;
  char *text = NULL;
  h5_read_attribute_text(object, ".", name, &text);
  free(text);
  return 0;
}

static herr_t read_object(hid_t file, const char *name, const H5O_info_t *info, void *unused) {
  (void)info;
  (void)unused;
  const hid_t object = H5Oopen(file, name, H5P_DEFAULT);
  if (object < 0) return 0;
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, read_attribute, NULL);
  int    n    = 0;
  char **text = NULL;
  if (H5Iget_type(object) == H5I_DATASET) h5_read_strings(file, name, &n, &text);
  for (int i = 0; i < n; i++) free(text[i]);
  free(text);
  H5Oclose(object);
  return 0;
}

static shb_status read_texts(const char *path) {
  hid_t file;
  SHB_TRY(open_guarded(path, &file));
  H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, read_object, NULL);
  return h5_close(file);
}

/* Exit code of the child that read without a crash what is refused. */
enum { REFUSED = 100 };

/* In the child. */
static int read_apart(void *path) {
  const shb_status status = read_texts(path);
  H5close(); /* a damaged heap is found when its blocks are given back */
  return status == SHB_OK ? SHB_OK : REFUSED;
}

/* Let a child process read the texts of a file whose checksum says nothing. Over a damaged one HDF5
 * may crash, or go round for ever. */
static shb_status try_texts(const char *path, long seconds) {
  shb_child_end end;
  SHB_TRY(shb_child_try(read_apart, (void *)path, seconds, &end));
  SHB_CHECK(end.signal != SIGXCPU && end.signal != SIGKILL, SHB_ERR_INPUT,
            "%s: is damaged: HDF5 reads it without an end; write or copy it again", path);
  SHB_CHECK(!end.signal && (end.code == SHB_OK || end.code == REFUSED), SHB_ERR_INPUT,
            "%s: is damaged: HDF5 crashed while it was read; write or copy it again", path);
  if (end.code == SHB_OK) return SHB_OK;
  hid_t file; /* once more here, for the reason */
  SHB_TRY(open_guarded(path, &file));
  return h5_close(file);
}

/* The file that was tried last; a stage opens its input several times. */
static struct stat tried;

static bool is_tried(const struct stat *now) {
  return now->st_dev == tried.st_dev && now->st_ino == tried.st_ino &&
         now->st_size == tried.st_size && now->st_mtim.tv_sec == tried.st_mtim.tv_sec &&
         now->st_mtim.tv_nsec == tried.st_mtim.tv_nsec;
}

static shb_status try_once(const char *path) {
  struct stat now;
  SHB_CHECK(stat(path, &now) == 0, SHB_ERR_IO, "%s: cannot be read: %s", path, strerror(errno));
  if (is_tried(&now)) return SHB_OK;
  SHB_TRY(try_texts(path, TRIAL + (long)now.st_size / TRIAL_BYTES));
  tried = now;
  return SHB_OK;
}

shb_status h5_open(const char *path, hid_t *file) {
  *file = H5I_INVALID_HID;
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  SHB_TRY(check_readable(path));
  const h5_stamp_state stamp = h5_stamp_check(path);
  SHB_CHECK(stamp != H5_UNREADABLE, SHB_ERR_IO, "%s: cannot be read: %s", path, strerror(errno));
  SHB_CHECK(stamp != H5_SHORT, SHB_ERR_IO, "%s: is truncated; write or copy it again", path);
  if (stamp != H5_INTACT) SHB_TRY(try_once(path));
  if (stamp == H5_CHANGED) warn_changed(path);
  return open_guarded(path, file);
}

shb_status h5_check_earlier(const char *path) {
  if (access(path, F_OK) != 0) return SHB_OK;
  SHB_TRY(check_readable(path));
  const h5_stamp_state stamp = h5_stamp_check(path);
  SHB_CHECK(stamp != H5_UNREADABLE, SHB_ERR_IO, "%s: cannot be read: %s", path, strerror(errno));
  const bool whole = stamp == H5_INTACT || (stamp == H5_UNSTAMPED && try_once(path) == SHB_OK);
  SHB_CHECK(whole, SHB_ERR_IO, "%s: is damaged, or was changed since it was written", path);
  return SHB_OK;
}

/* Returns 0 or errno. */
static int write_all(int fd, const char *data, size_t size) {
  int why = 0;
  while (size > 0 && !why) {
    ssize_t n = write(fd, data, size);
    if (n > 0) {
      data += n;
      size -= (size_t)n;
    } else if (n < 0 && errno != EINTR) {
      why = errno;
    } else if (n == 0) {
      why = ENOSPC;
    }
  }
  return why;
}

/* Write the stamp and the image; a file that is not whole is removed. Returns 0 or errno. */
static int write_stamped(const char *path, const char *image, size_t size) {
  char stamp[H5_STAMP];
  int  fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666), why = fd < 0 ? errno : 0;
  h5_stamp_make(image, size, stamp);
  if (!why) why = write_all(fd, stamp, sizeof stamp);
  if (!why) why = write_all(fd, image, size);
  if (fd >= 0 && close(fd) != 0 && !why) why = errno;
  if (why) remove_file(path);
  return why;
}

static shb_status write_image(hid_t file) {
  char  path[4096];
  void *handle = NULL;
  if (H5Fget_name(file, path, sizeof path) < 0 || H5Fflush(file, H5F_SCOPE_GLOBAL) < 0)
    return h5_failed(SHB_ERR_IO, file, ".", "cannot be written");
  ssize_t size = H5Fget_file_image(file, NULL, 0);
  if (size <= 0 || H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0 || !handle)
    return h5_failed(SHB_ERR_IO, file, ".", "cannot be written");
  int why = write_stamped(path, *(char **)handle, (size_t)size); /* the core driver's buffer */
  return why ? write_failed(path, why) : SHB_OK;
}

shb_status h5_close(hid_t file) {
  if (file < 0) return SHB_OK;
  unsigned   intent = 0;
  shb_status status = SHB_OK;
  const bool known = H5Fget_intent(file, &intent) >= 0, writing = intent & H5F_ACC_RDWR;
  if (known && writing) status = write_image(file);
  char path[4096] = "";
  if (known && writing && H5Fget_name(file, path, sizeof path) < 0) *path = '\0';
  const bool closed = H5Fclose(file) >= 0;
  if (!closed && *path) remove_file(path); /* the caller does not publish it */
  if (known && !writing) stop_reading();
  if (!closed && status == SHB_OK) SHB_FAIL(SHB_ERR_IO, "an HDF5 file could not be closed");
  return status;
}

void h5_abandon(hid_t file) {
  if (file < 0) return;
  char     path[4096];
  unsigned intent = 0;
  bool     ours   = H5Fget_name(file, path, sizeof path) > 0 && H5Fget_intent(file, &intent) >= 0 &&
              (intent & H5F_ACC_RDWR);
  H5Fclose(file);
  if (!(intent & H5F_ACC_RDWR)) stop_reading();
  if (ours) remove_file(path);
}

/* Write a file under a temporary name. earlier: what it begins with, or NULL. */
static shb_status write_file(const char *earlier, const char *temporary, h5_fill fill,
                             const void *context) {
  hid_t file;
  SHB_TRY(earlier ? h5_create_like(earlier, temporary, &file) : h5_create(temporary, &file));
  shb_status status = fill(file, context);
  if (status == SHB_OK) return h5_close(file);
  h5_abandon(file);
  return status;
}

shb_status h5_publish_like(const char *earlier, const char *path, h5_fill fill,
                           const void *context) {
  char *temporary = shb_publish_temporary(path);
  SHB_CHECK(temporary, SHB_ERR_IO, "%s: no memory", path);
  shb_status status = write_file(earlier, temporary, fill, context);
  if (status == SHB_OK) status = shb_publish(temporary, path);
  free(temporary);
  return status;
}

shb_status h5_publish(const char *path, h5_fill fill, const void *context) {
  return h5_publish_like(NULL, path, fill, context);
}
