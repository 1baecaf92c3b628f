#include "postproc/draw/template.h"

#include <assert.h>
#include <string.h>

post_buffer *post_value(post_values_list *values, const char *name) {
  assert(values->n < POST_VALUES);
  values->name[values->n] = name;
  return &values->text[values->n++];
}

void post_values_list_free(post_values_list *values) {
  for (int i = 0; i < values->n; i++) post_buffer_free(&values->text[i]);
  *values = (post_values_list){0};
}

/* A place {{…}}: its kind ('#', '^', '/' or 0), its value, and the text behind it. */
typedef struct {
  char        kind;
  int         value;
  const char *behind;
} tag;

static shb_status read_tag(const char *at, const post_values_list *values, tag *t) {
  const char *end = strstr(at, "}}"), *name = at + 2;
  SHB_CHECK(end, SHB_ERR_INPUT, "template: a place {{ is not closed");
  *t = (tag){strchr("#^/", *name) ? *name : 0, 0, end + 2};
  name += t->kind != 0;
  const size_t length = (size_t)(end - name);
  while (t->value < values->n && (strncmp(values->name[t->value], name, length) != 0 ||
                                  values->name[t->value][length] != '\0'))
    t->value++;
  SHB_CHECK(t->value < values->n, SHB_ERR_INPUT, "template: {{%.*s}} has no value", (int)length,
            name);
  return SHB_OK;
}

/* Fill from *text to the end of the part of a value (-1: of the whole); out NULL: skip it. */
static shb_status fill(const char **text, int part, const post_values_list *values,
                       post_buffer *out) {
  for (;;) {
    const char *at = strstr(*text, "{{");
    tag         t  = {0};
    if (out) post_put_bytes(out, *text, at ? (size_t)(at - *text) : strlen(*text));
    SHB_CHECK(at || part < 0, SHB_ERR_INPUT, "template: {{#%s}} does not end", values->name[part]);
    if (!at) return SHB_OK;
    SHB_TRY(read_tag(at, values, &t));
    const post_buffer *value = &values->text[t.value];
    *text                    = t.behind;
    if (t.kind == '/') {
      SHB_CHECK(t.value == part, SHB_ERR_INPUT, "template: {{/%s}} ends another part",
                values->name[t.value]);
      return SHB_OK;
    }
    if (t.kind) {
      const bool shown = (value->length > 0) == (t.kind == '#');
      SHB_TRY(fill(text, t.value, values, shown ? out : NULL));
    } else if (out) {
      post_put_bytes(out, value->text, value->length);
    }
  }
}

shb_status post_template(const char *text, const post_values_list *values, post_buffer *out) {
  SHB_TRY(fill(&text, -1, values, out));
  for (int i = 0; i < values->n; i++) out->failed = out->failed || values->text[i].failed;
  SHB_CHECK(!out->failed, SHB_ERR_IO, "not enough memory for the page");
  return SHB_OK;
}
