#include "cases/converge/resized_case.h"

#include <stdlib.h>
#include <string.h>

#include "cases/parse/yaml.h"
#include "postproc/draw/text_buffer.h"

/* A part of the text to be replaced. */
typedef struct {
  size_t at, length;
  double value; /* m */
} patch;

/* Byte offset of a place in the text, whose columns count characters. */
static size_t offset_of(const char *text, int line, int column) {
  const char *at = text;
  for (int i = 1; i < line && at; i++) {
    at = strchr(at, '\n');
    if (at) at++;
  }
  if (!at) return strlen(text);
  for (int i = 1; i < column && *at; i++) {
    at++;
    while ((*at & 0xC0) == 0x80) at++;
  }
  return (size_t)(at - text);
}

/* Finds a scalar in the text, plain or in quotes. */
static shb_status place(const case_file *file, const case_node *node, double value, patch *out) {
  size_t      at = offset_of(file->text, node->line, node->column), n = strlen(node->text);
  const char *start  = file->text + at;
  bool        quoted = *start == '"' || *start == '\'';
  SHB_CHECK(strncmp(start + quoted, node->text, n) == 0 && (!quoted || start[n + 1] == *start),
            SHB_ERR_INPUT,
            "%s:%d:%d: the element size cannot be replaced; write it as a plain number", file->path,
            node->line, node->column);
  *out = (patch){at, n + 2 * quoted, value};
  return SHB_OK;
}

static shb_status find_patches(const case_file *file, const case_node *root, double factor,
                               patch out[2], int *n) {
  static const char *const names[] = {"size", "shroud_size"};
  const double             value[] = {file->blade.size, file->blade.shroud_size};
  const case_node         *node    = root;
  *n                               = 0;
  for (const char *const *part = (const char *const[]){"mesh", "blade", NULL}; node && *part;
       part++)
    node = case_node_find(node, *part);
  SHB_CHECK(node, SHB_ERR_INPUT, "%s: has no mesh.blade", file->path);
  for (int i = 0; i < 2; i++) {
    const case_node *child = case_node_find(node, names[i]);
    if (child && child->kind == CASE_SCALAR)
      SHB_TRY(place(file, child, factor * value[i], &out[(*n)++]));
  }
  if (*n == 2 && out[0].at > out[1].at) {
    patch first = out[1];
    out[1]      = out[0];
    out[0]      = first;
  }
  return SHB_OK;
}

shb_status case_resize_mesh(const case_file *file, double factor, const char *path) {
  case_issues issues = case_issues_start(file->path, file->text, strlen(file->text));
  case_node  *root   = case_document_parse(&issues);
  patch       patches[2];
  int         n      = 0;
  shb_status  status = SHB_ERR_INPUT;
  if (root) status = find_patches(file, root, factor, patches, &n);
  if (!root && issues.no_memory)
    status = shb_fail(SHB_ERR_IO, __FILE__, __LINE__, "%s: out of memory", file->path);
  else if (!root)
    shb_fail(status, __FILE__, __LINE__, "%s: not YAML", file->path);
  case_document_free(root);
  case_issues_free(&issues);
  SHB_TRY(status);
  post_buffer out = {0};
  size_t      at  = 0;
  for (int i = 0; i < n; i++) {
    post_put_bytes(&out, file->text + at, patches[i].at - at);
    post_put(&out, "%.9g m", patches[i].value);
    at = patches[i].at + patches[i].length;
  }
  post_put_bytes(&out, file->text + at, strlen(file->text) - at);
  status = post_buffer_publish(&out, path);
  post_buffer_free(&out);
  return status;
}
