#include "postproc/study/study_page.h"

#include "postproc/draw/number_format.h"
#include "postproc/draw/template.h"
#include "postproc/report/page.h"
#include "postproc/study/study_data.h"
#include "postproc/study/study_findings.h"

static void put_lede(const design_study *s, post_buffer *out) {
  post_put(out, "%d design%s", s->n, s->n == 1 ? "" : "s");
  for (int k = 0; k < s->n_keys; k++) {
    post_put(out, "%s<code>", k == 0 ? " of " : k == s->n_keys - 1 ? " and " : ", ");
    post_put_escaped(out, s->key[k].name);
    post_put(out, "</code>");
  }
  post_put(out, ", plan: ");
  post_put_escaped(out, s->plan);
  if (s->case_path && *s->case_path) {
    post_put(out, ", case: <code>");
    post_put_escaped(out, s->case_path);
    post_put(out, "</code>");
  }
  post_put(out, ".");
}

static void escaped(post_values_list *values, const char *name, const char *text) {
  post_put_escaped(post_value(values, name), text ? text : "");
}

static shb_status fill(const design_study *s, post_values_list *v) {
  double tolerance;
  char   percent[POST_NUMBER];
  escaped(v, "name", s->name && *s->name ? s->name : "study");
  post_put(post_value(v, "css"), "%s%s", post_page_css, post_study_css);
  put_lede(s, post_value(v, "lede"));
  study_headline(s, post_value(v, "headline"));
  post_buffer *findings = post_value(v, "findings");
  study_key_figures(s, findings);
  study_findings(s, findings);
  escaped(v, "revision", shb_revision());
  escaped(v, "study", s->text);
  escaped(v, "case", s->case_text);
  SHB_TRY(study_data(s, post_value(v, "data"), &tolerance));
  post_put(post_value(v, "tolerance"), "%s", post_percent(percent, tolerance));
  post_put(post_value(v, "script"), "%s", post_study_js);
  return SHB_OK;
}

shb_status study_page(const design_study *s, post_buffer *out) {
  post_values_list values = {0};
  shb_status       status = fill(s, &values);
  if (status == SHB_OK) status = post_template(post_study_html, &values, out);
  post_values_list_free(&values);
  return status;
}
