#define _GNU_SOURCE /* strverscmp */
#include "postproc/inspect/h5_tree.h"

#include <ctype.h>
#include <hdf5_hl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "postproc/draw/number_format.h"
#include "postproc/inspect/value_range.h"

enum { NAME = 256, MAX_DEPTH = 24, ATTRIBUTE = 80 };
static const double MOST_SECONDS = 10; /* for the values of one dataset */

/* One line of the output by columns. */
typedef struct {
  char lead[3 * MAX_DEPTH * 4]; /* lines of the tree */
  char name[NAME];
  char type[POST_VALUE_RANGE], shape[POST_VALUE_RANGE], range[POST_VALUE_RANGE];
  /* Units; long_name, or the attributes of a group. */
  char units[ATTRIBUTE], about[2 * NAME];
  bool group;
} line;

/* An object that was found already: objects with several names are shown once. */
typedef struct {
  haddr_t address;
  char    path[NAME];
} visited;

typedef struct {
  post_tree_style style;
  line           *lines;
  visited        *seen;
  int             n_lines, n_seen;
  bool            failed; /* out of memory */
} walk;

/* ---------------------------------------------------------------- attributes and shapes */

static line *new_line(walk *w) {
  line *lines = realloc(w->lines, (size_t)(w->n_lines + 1) * sizeof *lines);
  if (!lines) {
    w->failed = true;
    return NULL;
  }
  w->lines          = lines;
  lines[w->n_lines] = (line){0};
  return &lines[w->n_lines++];
}

/* Value of a scalar attribute as text, cut to size; "" if it is no scalar number or string. */
static void attribute_text(hid_t object, const char *name, char *out, size_t size) {
  hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  *out            = '\0';
  if (attribute < 0) return;
  hid_t       type = H5Aget_type(attribute), space = H5Aget_space(attribute);
  H5T_class_t kind = H5Tget_class(type);
  double      value;
  char       *text = NULL;
  bool        one  = H5Sget_simple_extent_npoints(space) == 1;
  if (one && kind == H5T_STRING && H5Tis_variable_str(type) > 0) {
    if (H5Aread(attribute, type, &text) >= 0 && text) {
      snprintf(out, size, "%s", text);
      H5free_memory(text);
    }
  } else if (one && kind == H5T_STRING && (text = calloc(H5Tget_size(type) + 1, 1)) != NULL) {
    if (H5Aread(attribute, type, text) >= 0) snprintf(out, size, "%s", text);
    free(text);
  } else if (one && (kind == H5T_INTEGER || kind == H5T_FLOAT) &&
             H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0) {
    snprintf(out, size, "%.10g", value);
  }
  H5Sclose(space);
  H5Tclose(type);
  H5Aclose(attribute);
  for (char *c = out; *c; c++)
    if (iscntrl((unsigned char)*c)) *c = ' ';
}

/* Attributes that are already part of a dataset's line, or HDF5's own. */
static bool is_internal_attribute(const char *name) {
  static const char *const known[] = {
      "units",          "long_name",        "CLASS",     "NAME",    "REFERENCE_LIST",
      "DIMENSION_LIST", "DIMENSION_LABELS", "case_text", "settings"};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (strcmp(name, known[i]) == 0) return true;
  return false;
}

typedef struct {
  char  *out;
  size_t size;
} text_room;

static herr_t add_attribute(hid_t object, const char *name, const H5A_info_t *info, void *data) {
  (void)info;
  text_room *room = data;
  char       value[ATTRIBUTE];
  if (is_internal_attribute(name)) return 0;
  attribute_text(object, name, value, sizeof value);
  size_t used = strlen(room->out);
  if (*value && used + 4 < room->size)
    snprintf(room->out + used, room->size - used, "%s%s: %s", used ? "; " : "", name, value);
  return 0;
}

static void all_attributes(hid_t object, char *out, size_t size) {
  text_room room = {out, size};
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, NULL, add_attribute, &room);
}

/* Noun that a dimension scale counts, from its path: /probe/name counts probes, /modes/frequency
 * modes, /branch_3/frequency points; else its own name. */
static const char *counted_by(char *path) {
  char *slash = strrchr(path, '/');
  if (!slash) return path;
  const char *own = slash + 1;
  *slash          = '\0';
  const char *up = strrchr(path, '/'), *parent = up ? up + 1 : path;
  if (strcmp(own, "name") == 0 && *parent) return parent;
  if (strcmp(own, "frequency") == 0 && strcmp(parent, "modes") == 0) return "mode";
  if (strcmp(own, "frequency") == 0 && strncmp(parent, "branch_", 7) == 0) return "point";
  return own;
}

static herr_t scale_name(hid_t dataset, unsigned dim, hid_t scale, void *data) {
  (void)dataset, (void)dim;
  text_room *room       = data;
  char       path[NAME] = "";
  if (H5Iget_name(scale, path, sizeof path) > 0)
    snprintf(room->out, room->size, "%s", counted_by(path));
  return 1;
}

/* "[point 312, pair 1, 3]" */
static void put_shape(hid_t dataset, char out[POST_VALUE_RANGE]) {
  hid_t   space             = H5Dget_space(dataset);
  hsize_t dim[H5S_MAX_RANK] = {0};
  int     rank              = H5Sget_simple_extent_dims(space, dim, NULL);
  size_t  used              = 0;
  bool    scale             = H5DSis_scale(dataset) > 0;
  out[0]                    = '\0';
  for (int d = 0; d < rank && used < 130; d++) {
    char      name[32] = "";
    text_room room     = {name, sizeof name};
    if (!scale && H5DSget_num_scales(dataset, (unsigned)d) > 0)
      H5DSiterate_scales(dataset, (unsigned)d, NULL, scale_name, &room);
    used += (size_t)snprintf(out + used, POST_VALUE_RANGE - used, "%s%s%s%llu", d ? ", " : "[",
                             name, *name ? " " : "", (unsigned long long)dim[d]);
  }
  if (rank > 0) snprintf(out + used, POST_VALUE_RANGE - used, "]");
  H5Sclose(space);
}

/* ---------------------------------------------------------------- walking */

static int by_number(const void *a, const void *b) {
  return strverscmp(*(char *const *)a, *(char *const *)b);
}

/* Names of a group's links, sorted with numbers in order; malloc'ed. */
static char **link_names(hid_t group, int *n) {
  H5G_info_t info;
  *n = 0;
  if (H5Gget_info(group, &info) < 0) return NULL;
  char **names = calloc((size_t)info.nlinks + 1, sizeof *names);
  for (hsize_t i = 0; names && i < info.nlinks; i++) {
    ssize_t size =
        H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, NULL, 0, H5P_DEFAULT);
    char *name = size >= 0 ? malloc((size_t)size + 1) : NULL;
    if (!name) break;
    H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, name, (size_t)size + 1,
                       H5P_DEFAULT);
    names[(*n)++] = name;
  }
  if (names) qsort(names, (size_t)*n, sizeof *names, by_number);
  return names;
}

/* True if both names have equal text before a number at the end, as branch_0 and branch_7. */
static bool same_series(const char *a, const char *b) {
  size_t na = strlen(a), nb = strlen(b);
  while (na > 0 && isdigit((unsigned char)a[na - 1])) na--;
  while (nb > 0 && isdigit((unsigned char)b[nb - 1])) nb--;
  return na == nb && na > 0 && a[na] && b[nb] && strncmp(a, b, na) == 0;
}

/* First path of an object that was found before, or NULL; the object is then remembered. */
static const char *visited_before(walk *w, hid_t object) {
  H5O_info_t info;
  if (H5Oget_info(object, &info) < 0 || info.rc < 2) return NULL;
  for (int i = 0; i < w->n_seen; i++)
    if (w->seen[i].address == info.addr) return w->seen[i].path;
  visited *seen = realloc(w->seen, (size_t)(w->n_seen + 1) * sizeof *seen);
  if (!seen) {
    w->failed = true;
    return NULL;
  }
  w->seen         = seen;
  seen[w->n_seen] = (visited){.address = info.addr};
  H5Iget_name(object, seen[w->n_seen++].path, NAME);
  return NULL;
}

static void describe_dataset(hid_t dataset, post_tree_style style, line *l) {
  hid_t type = H5Dget_type(dataset);
  post_type_name(type, l->type);
  H5Tclose(type);
  put_shape(dataset, l->shape);
  post_value_range(dataset, MOST_SECONDS, l->range);
  attribute_text(dataset, "units", l->units, sizeof l->units);
  attribute_text(dataset, "long_name", l->about, sizeof l->about);
  if (style.verbose) all_attributes(dataset, l->about, sizeof l->about);
}

/* Describe a soft link without following it: its target is shown elsewhere. h5_open accepts no
 * link to another file. */
static bool describe_link(hid_t group, const char *name, line *l) {
  H5L_info_t info;
  char       target[NAME] = "";
  if (H5Lget_info(group, name, &info, H5P_DEFAULT) < 0 || info.type == H5L_TYPE_HARD) return false;
  if (info.u.val_size < NAME) H5Lget_val(group, name, target, NAME, H5P_DEFAULT);
  const bool there = H5Oexists_by_name(group, name, H5P_DEFAULT) > 0;
  snprintf(l->about, sizeof l->about, "→ %s%s", target, there ? "" : " (missing)");
  return true;
}

static void walk_group(walk *w, hid_t group, const char *lead, int depth);

/* Add the line of one member and the lines below it. lead: text before it, and before its
 * children. */
static void walk_member(walk *w, hid_t group, const char *name, const char *lead[2], int depth,
                        bool folded) {
  line *l = new_line(w);
  if (!l) return;
  snprintf(l->lead, sizeof l->lead, "%s", lead[0]);
  snprintf(l->name, sizeof l->name, "%s", name);
  for (char *c = l->name; *c; c++)
    if (iscntrl((unsigned char)*c)) *c = '?';
  if (describe_link(group, name, l)) return;
  hid_t object = H5Oopen(group, name, H5P_DEFAULT);
  if (object < 0) {
    snprintf(l->about, sizeof l->about, "(cannot be opened)");
    return;
  }
  H5I_type_t  kind  = H5Iget_type(object);
  const char *first = visited_before(w, object);
  l->group          = kind == H5I_GROUP;
  if (first) {
    snprintf(l->about, sizeof l->about, "= %s", first);
  } else if (kind == H5I_DATASET) {
    describe_dataset(object, w->style, l);
  } else if (kind == H5I_GROUP) {
    all_attributes(object, l->about, sizeof l->about);
    if (!folded) walk_group(w, object, lead[1], depth + 1); /* this may move l */
  }
  H5Oclose(object);
}

static bool is_dataset(hid_t group, const char *name) {
  H5O_info_t info;
  return H5Oexists_by_name(group, name, H5P_DEFAULT) > 0 &&
         H5Oget_info_by_name(group, name, &info, H5P_DEFAULT) >= 0 && info.type == H5O_TYPE_DATASET;
}

/* Number of datasets from names[i] on inside a numbered series, without its first and last. */
static int inner_series(hid_t group, char **names, int n, int i) {
  int count = 0;
  while (i > 0 && i + count < n - 1 && same_series(names[i - 1], names[i + count]) &&
         same_series(names[i - 1], names[i + count + 1]) && is_dataset(group, names[i + count]))
    count++;
  return count;
}

static void walk_group(walk *w, hid_t group, const char *lead, int depth) {
  int    n;
  char **names = link_names(group, &n);
  for (int i = 0; i < n && !w->failed && depth < MAX_DEPTH; i++) {
    char own[sizeof w->lines->lead], below[sizeof w->lines->lead];
    bool last = i == n - 1;
    snprintf(own, sizeof own, "%s%s", lead, last ? "└─ " : "├─ ");
    snprintf(below, sizeof below, "%s%s", lead, last ? "   " : "│  ");
    int   skipped = w->style.verbose ? 0 : inner_series(group, names, n, i);
    line *l       = skipped > 1 ? new_line(w) : NULL;
    if (l) {
      snprintf(l->lead, sizeof l->lead, "%s", own);
      snprintf(l->name, sizeof l->name, "⋮ %d more", skipped);
      i += skipped - 1;
      continue;
    }
    bool folded = !w->style.verbose && i > 0 && same_series(names[i - 1], names[i]);
    walk_member(w, group, names[i], (const char *[2]){own, below}, depth, folded);
  }
  for (int i = 0; i < n; i++) free(names[i]);
  if (!names) w->failed = true;
  free(names);
}

/* ---------------------------------------------------------------- printing */

/* Number of characters: bytes that do not continue a UTF-8 sequence. */
static int width(const char *text) {
  int n = 0;
  for (; *text; text++) n += ((unsigned char)*text & 0xc0) != 0x80;
  return n;
}

static int larger(int a, int b) {
  return a > b ? a : b;
}

static void put_column(post_buffer *out, const char *text, int columns) {
  post_put(out, "%s%*s", text, larger(0, columns - width(text)), "");
}

/* The whole text, or its first 72 characters. */
static void put_about(const line *l, post_tree_style style, post_buffer *out) {
  size_t n     = 0;
  int    shown = 0;
  for (; l->about[n] && (style.verbose || shown < 72); n++)
    shown += ((unsigned char)l->about[n] & 0xc0) != 0x80;
  while (((unsigned char)l->about[n] & 0xc0) == 0x80) n++; /* whole characters */
  post_put(out, "%s%.*s%s%s", style.colour ? "\033[2m" : "", (int)n, l->about,
           l->about[n] ? "…" : "", style.colour ? "\033[0m" : "");
}

static void put_line(const line *l, const int columns[5], post_tree_style style, post_buffer *out) {
  bool        colour = style.colour;
  const char *dim = colour ? "\033[2m" : "", *bold = colour ? "\033[1m" : "",
             *off = colour ? "\033[0m" : "";
  post_put(out, "%s%s%s%s%s%s%s", dim, l->lead, off, l->group ? bold : "", l->name,
           l->group ? "/" : "", l->group ? off : "");
  if (!*l->type) {
    post_put(out, *l->about ? "  " : "");
    if (*l->about) put_about(l, style, out);
    post_put(out, "\n");
    return;
  }
  post_put(out, "%*s  ", larger(0, columns[0] - width(l->lead) - width(l->name)), "");
  const char *cell[4] = {l->type, l->shape, l->range, l->units};
  for (int i = 0; i < 4; i++) {
    put_column(out, cell[i], columns[i + 1]);
    post_put(out, "  ");
  }
  if (*l->about) put_about(l, style, out);
  post_put(out, "\n");
}

static void put_lines(const walk *w, post_buffer *out) {
  int columns[5] = {0};
  for (int i = 0; i < w->n_lines; i++) {
    const line *l = &w->lines[i];
    if (!*l->type) continue;
    columns[0] = larger(columns[0], width(l->lead) + width(l->name));
    columns[1] = larger(columns[1], width(l->type));
    columns[2] = larger(columns[2], width(l->shape));
    columns[3] = larger(columns[3], width(l->range));
    columns[4] = larger(columns[4], width(l->units));
  }
  for (int i = 1; i < 5; i++)
    if (columns[i] > 60) columns[i] = 60;
  for (int i = 0; i < w->n_lines; i++) put_line(&w->lines[i], columns, w->style, out);
}

shb_status post_tree(hid_t file, post_tree_style style, post_buffer *out) {
  walk  w    = {.style = style};
  hid_t root = H5Gopen2(file, "/", H5P_DEFAULT);
  SHB_CHECK(root >= 0, SHB_ERR_IO, "the root group cannot be read: the file is damaged");
  walk_group(&w, root, "", 0);
  H5Gclose(root);
  if (!w.failed) put_lines(&w, out);
  free(w.lines);
  free(w.seen);
  SHB_CHECK(!w.failed, SHB_ERR_IO, "a group cannot be read, or not enough memory to list the file");
  return SHB_OK;
}
