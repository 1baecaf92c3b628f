#include "postproc/inspect/value_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/shortest.h"
#include "modal/hdf5/h5.h"

enum { LABEL = 160, PLACE = 400 };

/* Indices from, from + 1, ... below to; or those of the marked points. */
typedef struct {
  hsize_t from, to;
} range;

typedef struct {
  char    label[LABEL]; /* with the unit */
  double *value;        /* [rows]; NULL for text */
  char  **text;         /* [rows] */
} column;

typedef struct {
  hid_t   file;
  char    path[PLACE];      /* of the object */
  char    selection[PLACE]; /* inside the brackets; "" for all */
  int     n_rows;
  int    *row; /* [n_rows] indices in the file */
  int     n, capacity;
  column *column; /* [n] */
} table;

static void table_free(table *t) {
  for (int c = 0; c < t->n; c++) {
    for (int i = 0; t->column[c].text && i < t->n_rows; i++) free(t->column[c].text[i]);
    free(t->column[c].text);
    free(t->column[c].value);
  }
  free(t->column);
  free(t->row);
}

/* ---------------------------------------------------------------- which values */

static shb_status split_place(const char *place, table *t) {
  size_t n = strcspn(place, "["), length = strlen(place);
  bool   closed = place[n] == '\0' || place[length - 1] == ']';
  SHB_CHECK(closed && length < PLACE, SHB_ERR_INPUT,
            "%s: a selection is written PATH[first, second, ...]", place);
  memcpy(t->path, place, n);
  t->path[n] = '\0';
  if (place[n]) snprintf(t->selection, PLACE, "%.*s", (int)(length - n - 2), place + n + 1);
  return SHB_OK;
}

/* The selection of dimension dim without blanks; "" where there is none. */
static void word_of(const table *t, int dim, char word[64]) {
  const char *at = t->selection;
  for (int i = 0; i < dim && at; i++) {
    at = strchr(at, ',');
    if (at) at++;
  }
  size_t n = 0;
  for (; at && *at && *at != ',' && n < 63; at++)
    if (*at != ' ') word[n++] = *at;
  word[n] = '\0';
}

/* An index with the meaning of -1; text must end after it. */
static bool read_index(const char *text, hsize_t length, long long *index) {
  char *end;
  *index = strtoll(text, &end, 10);
  if (*index < 0) *index += (long long)length;
  return end != text && *end == '\0';
}

static shb_status read_range(const table *t, int dim, hsize_t length, range *out) {
  char word[64], from[64], *to;
  word_of(t, dim, word);
  *out = (range){0, length};
  if (word[0] == '\0' || strcmp(word, ":") == 0) return SHB_OK;
  long long low = 0, high = (long long)length;
  strcpy(from, word);
  to        = strchr(from, ':');
  bool good = true;
  if (to) {
    *to++ = '\0';
    if (*from) good = read_index(from, length, &low);
    if (*to) good = read_index(to, length, &high) && good;
  } else {
    good = read_index(from, length, &low);
    high = low + 1;
  }
  SHB_CHECK(good, SHB_ERR_INPUT, "%s: '%s' is no selection; expected an index, from:to or ':'%s",
            t->path, word, dim == 0 ? ", or peak or fold" : "");
  SHB_CHECK(low >= 0 && low < high && high <= (long long)length, SHB_ERR_INPUT,
            "%s: '%s' is outside of dimension %d, which has the indices 0 to %lld", t->path, word,
            dim + 1, (long long)length - 1);
  *out = (range){(hsize_t)low, (hsize_t)high};
  return SHB_OK;
}

/* Path of the dataset "special" beside an object: in its group, or in the one above. */
static bool find_special(const table *t, char path[PLACE + 16]) {
  char  folder[PLACE];
  char *slash;
  strcpy(folder, t->path);
  do {
    snprintf(path, PLACE + 16, "%s/special", folder);
    if (h5_exists(t->file, path)) return true;
    slash = strrchr(folder, '/');
    if (slash) *slash = '\0';
  } while (slash);
  return false;
}

/* The rows marked as peaks (2) or folds (1). */
static shb_status choose_marked(table *t, const char *word, hsize_t length) {
  char     path[PLACE + 16];
  h5_shape shape = H5_SHAPE(length);
  int     *special, mark = word[0] == 'p' ? 2 : 1;
  SHB_CHECK(find_special(t, path), SHB_ERR_INPUT,
            "%s: no dataset 'special' beside it, so no point is marked as a %s", t->path, word);
  SHB_TRY(h5_read_int(t->file, path, &shape, &special));
  for (hsize_t i = 0; i < length; i++)
    if (special[i] == mark) t->row[t->n_rows++] = (int)i;
  free(special);
  SHB_CHECK(t->n_rows > 0, SHB_ERR_INPUT, "%s: no point is marked as a %s", t->path, word);
  return SHB_OK;
}

static shb_status choose_rows(table *t, hsize_t length) {
  char  word[64];
  range all;
  t->row = malloc((size_t)(length ? length : 1) * sizeof *t->row);
  SHB_CHECK(t->row, SHB_ERR_IO, "%s: not enough memory", t->path);
  word_of(t, 0, word);
  if (strcmp(word, "peak") == 0 || strcmp(word, "fold") == 0) return choose_marked(t, word, length);
  SHB_TRY(read_range(t, 0, length, &all));
  for (hsize_t i = all.from; i < all.to; i++) t->row[t->n_rows++] = (int)i;
  return SHB_OK;
}

/* ---------------------------------------------------------------- columns */

static column *new_column(table *t) {
  if (t->n == t->capacity) {
    int     capacity = t->capacity ? 2 * t->capacity : 16;
    column *grown    = realloc(t->column, (size_t)capacity * sizeof *grown);
    if (!grown) return NULL;
    t->column   = grown;
    t->capacity = capacity;
  }
  t->column[t->n] = (column){.value = NULL};
  return &t->column[t->n++];
}

/* "name[1,0].re in m" */
static void put_label(column *c, const char *name, int rank, const hsize_t index[H5_MAX_RANK],
                      const char *part, const char *unit) {
  size_t n = (size_t)snprintf(c->label, LABEL, "%.80s", name);
  for (int d = 1; d < rank; d++)
    n += (size_t)snprintf(c->label + n, LABEL - n, "%c%llu", d == 1 ? '[' : ',',
                          (unsigned long long)index[d]);
  if (rank > 1) n += (size_t)snprintf(c->label + n, LABEL - n, "]");
  n += (size_t)snprintf(c->label + n, LABEL - n, "%s", part);
  if (unit && unit[0] && strcmp(unit, "-") != 0 && n < LABEL)
    snprintf(c->label + n, LABEL - n, " in %.30s", unit);
}

/* A column of the values at one index in all dimensions but the first.
 *   values  [all rows][per][parts] */
static shb_status add_values(table *t, const char *name, const char *unit, h5_shape shape,
                             const hsize_t index[H5_MAX_RANK], int parts, const double *values) {
  size_t at = 0, per = 1;
  for (int d = 1; d < shape.rank; d++) {
    at = at * shape.dim[d] + index[d];
    per *= shape.dim[d];
  }
  for (int part = 0; part < parts; part++) {
    column *c = new_column(t);
    if (c) c->value = malloc((size_t)t->n_rows * sizeof *c->value);
    SHB_CHECK(c && c->value, SHB_ERR_IO, "%s: not enough memory", t->path);
    put_label(c, name, shape.rank, index, parts == 1 ? "" : part ? ".im" : ".re", unit);
    for (int i = 0; i < t->n_rows; i++)
      c->value[i] = values[((size_t)t->row[i] * per + at) * (size_t)parts + (size_t)part];
  }
  return SHB_OK;
}

/* One or two columns for each index in the chosen ranges of the dimensions after the first. */
static shb_status add_all(table *t, const char *name, const char *unit, h5_shape shape,
                          const range chosen[H5_MAX_RANK], int parts, const double *values) {
  hsize_t index[H5_MAX_RANK];
  for (int d = 1; d < shape.rank; d++) index[d] = chosen[d].from;
  while (true) {
    SHB_TRY(add_values(t, name, unit, shape, index, parts, values));
    int d = shape.rank - 1;
    while (d > 0 && ++index[d] == chosen[d].to) {
      index[d] = chosen[d].from;
      d--;
    }
    if (d <= 0) return SHB_OK;
  }
}

static shb_status add_texts(table *t, const char *path, const char *name) {
  int    n;
  char **text;
  SHB_TRY(h5_read_strings(t->file, path, &n, &text));
  column *c = new_column(t);
  if (c) c->text = calloc((size_t)t->n_rows, sizeof *c->text);
  bool good = c && c->text;
  if (good) snprintf(c->label, LABEL, "%.80s", name);
  for (int i = 0; good && i < t->n_rows; i++) good = (c->text[i] = strdup(text[t->row[i]]));
  for (int i = 0; i < n; i++) free(text[i]);
  free(text);
  SHB_CHECK(good, SHB_ERR_IO, "%s: not enough memory", path);
  return SHB_OK;
}

/* Read all numbers: integers and reals as double, complex ones as pairs. NaN is allowed.
 *   parts  out  1 or 2 */
static shb_status read_numbers(hid_t set, const char *path, size_t count, int *parts,
                               double **values) {
  hid_t stored = H5Dget_type(set), memory = -1;
  H5T_class_t class = H5Tget_class(stored);
  *parts            = class == H5T_COMPOUND ? 2 : 1;
  if (class == H5T_COMPOUND && H5Tget_nmembers(stored) == 2) {
    memory = H5Tcreate(H5T_COMPOUND, 2 * sizeof(double));
    for (unsigned i = 0; i < 2; i++) {
      char *name = H5Tget_member_name(stored, i);
      H5Tinsert(memory, name, i * sizeof(double), H5T_NATIVE_DOUBLE);
      H5free_memory(name);
    }
  } else if (class == H5T_INTEGER || class == H5T_FLOAT) {
    memory = H5Tcopy(H5T_NATIVE_DOUBLE);
  }
  H5Tclose(stored);
  SHB_CHECK(memory >= 0, SHB_ERR_INPUT, "%s: holds neither numbers nor text", path);
  size_t bytes = count * (size_t)*parts * sizeof **values;
  /* a small damaged file can declare terabytes; HDF5's filters compress by 1000 at most */
  bool claim = bytes >= (1u << 24) && bytes / 2048 > H5Dget_storage_size(set);
  *values    = claim ? NULL : malloc(bytes ? bytes : 1);
  bool read  = *values && H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, *values) >= 0;
  H5Tclose(memory);
  if (read) return SHB_OK;
  free(*values);
  *values = NULL;
  SHB_FAIL(SHB_ERR_IO, "%s: its %zu values cannot be read", path, count);
}

/* The columns of a dataset, whose rows are chosen by the first dataset of the table. */
static shb_status add_dataset(table *t, const char *path, const char *name) {
  h5_shape shape;
  range    chosen[H5_MAX_RANK];
  SHB_TRY(h5_shape_of(t->file, path, &shape));
  bool scalar = shape.rank == 0;
  if (scalar) shape = H5_SHAPE(1);
  int given = t->selection[0] ? 1 : 0;
  for (const char *c = t->selection; *c; c++) given += *c == ',';
  SHB_CHECK(given <= shape.rank, SHB_ERR_INPUT, "%s: %d selections for %d dimensions", path, given,
            shape.rank);
  for (int d = 1; d < shape.rank; d++) SHB_TRY(read_range(t, d, shape.dim[d], &chosen[d]));
  if (!t->row) SHB_TRY(choose_rows(t, shape.dim[0]));
  hid_t set  = H5Dopen2(t->file, path, H5P_DEFAULT);
  hid_t type = H5Dget_type(set);
  bool  text = H5Tget_class(type) == H5T_STRING;
  H5Tclose(type);
  shb_status status;
  if (text && shape.rank == 1 && !scalar) {
    status = add_texts(t, path, name);
  } else {
    int     parts;
    double *values = NULL;
    char   *unit   = NULL;
    status         = read_numbers(set, path, h5_count(shape), &parts, &values);
    if (status == SHB_OK) status = h5_read_attribute_text(t->file, path, "units", &unit);
    if (status == SHB_OK) status = add_all(t, name, unit, shape, chosen, parts, values);
    free(unit);
    free(values);
  }
  H5Dclose(set);
  return status;
}

/* ---------------------------------------------------------------- groups */

typedef struct {
  table     *t;
  hsize_t    length; /* of the first dimension */
  shb_status status;
} visit;

/* Adds a dataset that holds one number for each point. */
static herr_t take(hid_t group, const char *name, const H5O_info_t *info, void *context) {
  visit   *v = context;
  char     path[2 * PLACE];
  h5_shape shape;
  (void)group;
  if (info->type != H5O_TYPE_DATASET || strcmp(name, "frequency") == 0) return 0;
  snprintf(path, sizeof path, "%s/%s", v->t->path, name);
  if (h5_shape_of(v->t->file, path, &shape) != SHB_OK) return 0;
  if (shape.rank == 0 || shape.dim[0] != v->length || h5_count(shape) != v->length) return 0;
  v->status = add_dataset(v->t, path, name);
  return v->status == SHB_OK ? 0 : 1;
}

/* The datasets of one number a point, the frequency first. */
static shb_status add_group(table *t) {
  char     path[PLACE + 16];
  h5_shape shape;
  snprintf(path, sizeof path, "%s/frequency", t->path);
  SHB_CHECK(h5_exists(t->file, path), SHB_ERR_INPUT,
            "%s: a group without the dataset frequency; name one of its datasets", t->path);
  SHB_CHECK(!strchr(t->selection, ','), SHB_ERR_INPUT,
            "%s: a group takes one selection, that of the points", t->path);
  SHB_TRY(add_dataset(t, path, "frequency"));
  SHB_TRY(h5_shape_of(t->file, path, &shape));
  visit v = {t, shape.dim[0], SHB_OK};
  H5Ovisit_by_name2(t->file, t->path, H5_INDEX_NAME, H5_ITER_INC, take, &v, H5O_INFO_BASIC,
                    H5P_DEFAULT);
  return v.status;
}

static shb_status fill(table *t) {
  SHB_CHECK(h5_exists(t->file, t->path), SHB_ERR_INPUT,
            "%s: the file holds no such object; shroudhb inspect FILE lists them", t->path);
  H5O_info_t info;
  SHB_CHECK(H5Oget_info_by_name2(t->file, t->path, &info, H5O_INFO_BASIC, H5P_DEFAULT) >= 0,
            SHB_ERR_IO, "%s: cannot be read", t->path);
  if (info.type == H5O_TYPE_GROUP) return add_group(t);
  const char *slash = strrchr(t->path, '/');
  return add_dataset(t, t->path, slash ? slash + 1 : t->path);
}

/* ---------------------------------------------------------------- text */

static void format_cell(const column *c, int row, bool csv, char out[SHB_SHORTEST]) {
  if (csv)
    shb_shortest(c->value[row], out);
  else
    snprintf(out, SHB_SHORTEST, "%.9g", c->value[row]);
}

static void put_csv(const table *t, post_buffer *out) {
  post_put(out, "index");
  for (int c = 0; c < t->n; c++) {
    post_put(out, ",");
    post_put_csv(out, t->column[c].label);
  }
  post_put(out, "\n");
  for (int i = 0; i < t->n_rows; i++) {
    post_put(out, "%d", t->row[i]);
    for (int c = 0; c < t->n; c++) {
      char cell[SHB_SHORTEST];
      post_put(out, ",");
      if (t->column[c].text) post_put_csv(out, t->column[c].text[i]);
      if (t->column[c].value) format_cell(&t->column[c], i, true, cell);
      if (t->column[c].value) post_put(out, "%s", cell);
    }
    post_put(out, "\n");
  }
}

static void put_aligned(const table *t, post_buffer *out) {
  enum { NUMBER_WIDTH = 15 };
  post_put(out, "%7s", "index");
  for (int c = 0; c < t->n; c++) {
    int pad = NUMBER_WIDTH - (int)strlen(t->column[c].label);
    post_put(out, "%*s", 2 + (pad > 0 ? pad : 0), "");
    post_put_printable(out, t->column[c].label);
  }
  post_put(out, "\n");
  for (int i = 0; i < t->n_rows; i++) {
    post_put(out, "%7d", t->row[i]);
    for (int c = 0; c < t->n; c++) {
      char cell[SHB_SHORTEST];
      int  width = (int)strlen(t->column[c].label);
      if (width < NUMBER_WIDTH) width = NUMBER_WIDTH;
      post_put(out, "  ");
      if (t->column[c].text) post_put_printable(out, t->column[c].text[i]);
      if (t->column[c].value) format_cell(&t->column[c], i, false, cell);
      if (t->column[c].value) post_put(out, "%*s", width, cell);
    }
    post_put(out, "\n");
  }
}

shb_status post_value_table(const char *file, const char *place, bool csv, post_buffer *out) {
  table t = {0};
  SHB_TRY(split_place(place, &t));
  SHB_TRY(h5_open(file, &t.file));
  shb_status status = fill(&t);
  if (status == SHB_OK && csv) put_csv(&t, out);
  if (status == SHB_OK && !csv) put_aligned(&t, out);
  table_free(&t);
  H5Fclose(t.file);
  SHB_CHECK(!out->failed, SHB_ERR_IO, "%s: not enough memory to print %s", file, place);
  return status;
}
