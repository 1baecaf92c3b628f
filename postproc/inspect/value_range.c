#include "postproc/inspect/value_range.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/clock.h"
#include "postproc/draw/number_format.h"

/* Numbers and chunks that are read at once; HDF5 needs some 40 us a chunk. */
enum { PIECE = 1 << 18, CHUNKS = 1 << 12, MAX_STRINGS = 64, SHOWN_STRINGS = 4 };

typedef struct {
  double             lo, hi;
  unsigned long long finite, other;
  double             part; /* of the values, that were read */
} extent;

/* Member names of a complex compound, {r, i} or {real, imag}; false if the type is none. */
static bool complex_members(hid_t type, char *name[2]) {
  if (H5Tget_class(type) != H5T_COMPOUND || H5Tget_nmembers(type) != 2) return false;
  if (H5Tget_member_class(type, 0) != H5T_FLOAT || H5Tget_member_class(type, 1) != H5T_FLOAT)
    return false;
  name[0]    = H5Tget_member_name(type, 0);
  name[1]    = H5Tget_member_name(type, 1);
  bool known = name[0] && name[1] && name[0][0] == 'r' && name[1][0] == 'i';
  if (!known) {
    H5free_memory(name[0]);
    H5free_memory(name[1]);
  }
  return known;
}

static bool is_complex(hid_t type) {
  char *name[2];
  if (!complex_members(type, name)) return false;
  H5free_memory(name[0]);
  H5free_memory(name[1]);
  return true;
}

static void put_members(hid_t type, char out[POST_VALUE_RANGE]) {
  size_t used = (size_t)snprintf(out, POST_VALUE_RANGE, "compound {");
  int    n    = H5Tget_nmembers(type);
  for (int i = 0; i < n && used < 100; i++) {
    char *name = H5Tget_member_name(type, (unsigned)i);
    used += (size_t)snprintf(out + used, POST_VALUE_RANGE - used, "%s%.30s", i ? ", " : "",
                             name ? name : "?");
    H5free_memory(name);
  }
  snprintf(out + used, POST_VALUE_RANGE - used, "}");
}

char *post_type_name(hid_t type, char out[POST_VALUE_RANGE]) {
  size_t bits = 8 * H5Tget_size(type);
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
      snprintf(out, POST_VALUE_RANGE, "%s%zu", H5Tget_sign(type) == H5T_SGN_NONE ? "uint" : "int",
               bits);
      break;
    case H5T_FLOAT:
      snprintf(out, POST_VALUE_RANGE, "float%zu", bits);
      break;
    case H5T_STRING:
      strcpy(out, "string");
      break;
    case H5T_COMPOUND:
      if (is_complex(type))
        strcpy(out, "complex");
      else
        put_members(type, out);
      break;
    case H5T_REFERENCE:
      strcpy(out, "reference");
      break;
    case H5T_ENUM:
      strcpy(out, "enum");
      break;
    case H5T_VLEN:
      strcpy(out, "list of lists");
      break;
    case H5T_ARRAY:
      strcpy(out, "array");
      break;
    default:
      strcpy(out, "opaque");
      break;
  }
  return out;
}

/* Memory type of an element that can be read as one or two doubles; < 0 if it cannot. */
static hid_t number_type(hid_t type, int *parts) {
  H5T_class_t kind = H5Tget_class(type);
  char       *name[2];
  *parts = 1;
  if (kind == H5T_INTEGER || kind == H5T_FLOAT) return H5Tcopy(H5T_NATIVE_DOUBLE);
  if (!complex_members(type, name)) return -1;
  *parts    = 2;
  hid_t out = H5Tcreate(H5T_COMPOUND, 2 * sizeof(double));
  for (size_t i = 0; i < 2; i++) {
    if (out >= 0) H5Tinsert(out, name[i], i * sizeof(double), H5T_NATIVE_DOUBLE);
    H5free_memory(name[i]);
  }
  return out;
}

static void widen(extent *e, const double *values, size_t n, int parts) {
  for (size_t i = 0; i < n; i++) {
    double v = parts == 1 ? values[i] : hypot(values[2 * i], values[2 * i + 1]);
    if (!isfinite(v)) {
      e->other++;
      continue;
    }
    e->finite++;
    e->lo = fmin(e->lo, v);
    e->hi = fmax(e->hi, v);
  }
}

/* Numbers that are read at once. */
static hsize_t piece_room(hid_t dataset) {
  hsize_t chunk[H5S_MAX_RANK], numbers = 1;
  hid_t   list = H5Dget_create_plist(dataset);
  int     rank =
      list >= 0 && H5Pget_layout(list) == H5D_CHUNKED ? H5Pget_chunk(list, H5S_MAX_RANK, chunk) : 0;
  if (list >= 0) H5Pclose(list);
  for (int d = 0; d < rank && numbers < PIECE; d++) numbers *= chunk[d];
  return rank > 0 && numbers < PIECE / CHUNKS ? numbers * CHUNKS : PIECE;
}

/* Size of a piece: as many whole trailing dimensions as fit into room, a part of the next, one of
 * the rest. */
static void piece_of(hsize_t room, int rank, const hsize_t *dim, hsize_t *piece) {
  for (int d = rank - 1; d >= 0; d--) {
    piece[d] = dim[d] < room ? dim[d] : room;
    room     = piece[d] == dim[d] ? room / dim[d] : 1;
    if (room < 1) room = 1;
  }
}

/* Advance start to the next piece; false after the last. */
static bool next_piece(int rank, const hsize_t *dim, const hsize_t *piece, hsize_t *start) {
  for (int d = rank - 1; d >= 0; d--) {
    start[d] += piece[d];
    if (start[d] < dim[d]) return true;
    start[d] = 0;
  }
  return false;
}

static bool read_piece(hid_t dataset, hid_t space, hid_t type, const hsize_t *start,
                       const hsize_t *count, double *values) {
  int     rank  = H5Sget_simple_extent_ndims(space);
  hsize_t total = 1;
  for (int d = 0; d < rank; d++) total *= count[d];
  if (rank > 0 && H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) < 0)
    return false;
  hid_t memory = H5Screate_simple(1, &total, NULL);
  bool  good   = memory >= 0 && H5Dread(dataset, type, memory, space, H5P_DEFAULT, values) >= 0;
  if (memory >= 0) H5Sclose(memory);
  return good;
}

/* Read piece by piece until all is read or the time is over. */
static bool read_extent(hid_t dataset, hid_t space, hid_t type, int parts, double seconds,
                        extent *e) {
  double  end = shb_seconds() + seconds, all = (double)H5Sget_simple_extent_npoints(space);
  hsize_t dim[H5S_MAX_RANK] = {0}, piece[H5S_MAX_RANK] = {0}, start[H5S_MAX_RANK] = {0};
  int     rank   = H5Sget_simple_extent_dims(space, dim, NULL);
  double *values = malloc((size_t)PIECE * (size_t)parts * sizeof *values);
  bool    good   = values && rank >= 0;
  piece_of(piece_room(dataset), rank, dim, piece);
  do {
    hsize_t count[H5S_MAX_RANK], total = 1;
    for (int d = 0; d < rank; d++) {
      count[d] = start[d] + piece[d] <= dim[d] ? piece[d] : dim[d] - start[d];
      total *= count[d];
    }
    good = good && read_piece(dataset, space, type, start, count, values);
    if (good) widen(e, values, (size_t)total, parts);
  } while (good && shb_seconds() < end && next_piece(rank, dim, piece, start));
  e->part = (double)(e->finite + e->other) / all;
  free(values);
  return good;
}

static void put_extent(const extent *e, bool magnitude, char out[POST_VALUE_RANGE]) {
  char        lo[POST_NUMBER], hi[POST_NUMBER];
  const char *bar  = magnitude ? "|" : "";
  size_t      used = 0;
  post_plain(lo, e->lo, 4);
  post_plain(hi, e->hi, 4);
  if (e->finite == 0)
    strcpy(out, "no number");
  else if (e->lo == e->hi)
    used = (size_t)snprintf(out, POST_VALUE_RANGE, "%s%s%s", bar, lo, bar);
  else
    used = (size_t)snprintf(out, POST_VALUE_RANGE, "%s%s … %s%s", bar, lo, hi, bar);
  if (e->finite > 0 && e->other > 0)
    snprintf(out + used, POST_VALUE_RANGE - used, ", %llu NaN", e->other);
  used = strlen(out);
  if (e->part < 1)
    snprintf(out + used, POST_VALUE_RANGE - used, ", first %.2g %% read", 100 * e->part);
}

static void add_string(char out[POST_VALUE_RANGE], const char *text, size_t size, hssize_t i) {
  size_t used = strlen(out), n = strnlen(text, size < 24 ? size : 24);
  if (i == SHOWN_STRINGS) snprintf(out + used, POST_VALUE_RANGE - used, " …");
  if (i >= SHOWN_STRINGS) return;
  snprintf(out + used, POST_VALUE_RANGE - used, "%s%.*s%s", i ? ", " : "", (int)n, text,
           n == 24 && strnlen(text, size) > 24 ? "…" : "");
}

static bool read_strings(hid_t dataset, hid_t space, hid_t type, hssize_t n,
                         char out[POST_VALUE_RANGE]) {
  size_t size     = H5Tget_size(type);
  bool   variable = H5Tis_variable_str(type) > 0, good;
  char  *data     = calloc((size_t)n, size);
  out[0]          = '\0';
  good            = data && H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
  for (hssize_t i = 0; good && i < n; i++) {
    const char *text = data + (size_t)i * size;
    if (variable) memcpy(&text, text, sizeof text);
    add_string(out, text ? text : "", variable ? 4096 : size, i);
  }
  if (good && variable) H5Dvlen_reclaim(type, space, H5P_DEFAULT, data);
  free(data);
  for (char *c = out; *c; c++)
    if ((unsigned char)*c < 0x20 || *c == 0x7f) *c = ' ';
  return good;
}

/* Chunks of which none is in the file. */
static bool not_written(hid_t dataset) {
  hid_t list = H5Dget_create_plist(dataset);
  bool  none = list >= 0 && H5Pget_layout(list) == H5D_CHUNKED && H5Dget_storage_size(dataset) == 0;
  if (list >= 0) H5Pclose(list);
  return none;
}

static void describe(hid_t dataset, hid_t space, hid_t type, double seconds,
                     char out[POST_VALUE_RANGE]) {
  hssize_t n     = H5Sget_simple_extent_npoints(space);
  int      parts = 1;
  bool     good  = true;
  if (n == 0) {
    strcpy(out, "empty");
  } else if (not_written(dataset)) {
    strcpy(out, "not written");
  } else if (H5Tget_class(type) == H5T_STRING) {
    if (n <= MAX_STRINGS) good = read_strings(dataset, space, type, n, out);
  } else {
    hid_t  number = number_type(type, &parts);
    extent e      = {.lo = INFINITY, .hi = -INFINITY};
    if (number < 0) return;
    good = read_extent(dataset, space, number, parts, seconds, &e);
    if (good) put_extent(&e, parts == 2, out);
    H5Tclose(number);
  }
  if (!good) strcpy(out, "unreadable");
}

char *post_value_range(hid_t dataset, double seconds, char out[POST_VALUE_RANGE]) {
  hid_t space = H5Dget_space(dataset), type = H5Dget_type(dataset);
  out[0] = '\0';
  if (space >= 0 && type >= 0)
    describe(dataset, space, type, seconds, out);
  else
    strcpy(out, "unreadable");
  if (type >= 0) H5Tclose(type);
  if (space >= 0) H5Sclose(space);
  return out;
}
