/* A page from a template: text with named places.
 *
 *   {{name}}               the value, as it is (what is no HTML was escaped before)
 *   {{#name}} … {{/name}}  only where the value is not empty
 *   {{^name}} … {{/name}}  only where it is empty
 *
 * Such parts may hold others. */
#ifndef POSTPROC_DRAW_TEMPLATE_H
#define POSTPROC_DRAW_TEMPLATE_H

#include "postproc/draw/text_buffer.h"

enum { POST_VALUES = 64 };

/* Values by their names. */
typedef struct {
  int         n;
  const char *name[POST_VALUES];
  post_buffer text[POST_VALUES];
} post_values_list;

/* A new value, empty: put its text into the buffer. At most POST_VALUES; name is kept as it is. */
post_buffer *post_value(post_values_list *values, const char *name);

/* Write the template with its values. Errors: SHB_ERR_INPUT a name without value, a part that does
 * not end; SHB_ERR_IO no memory. */
shb_status post_template(const char *text, const post_values_list *values, post_buffer *out);
void       post_values_list_free(post_values_list *values);

#endif
