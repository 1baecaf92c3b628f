#include "postproc/study/study_page.h"

#include <string.h>

#include "postproc/draw/number_format.h"
#include "postproc/report/page.h"
#include "postproc/study/study_data.h"
#include "postproc/study/study_findings.h"

static const char *name_of(const design_study *s) {
  return s->name && *s->name ? s->name : "study";
}

static void put_head(const design_study *s, post_buffer *out) {
  post_page_open(name_of(s), "design study", out);
  post_put_bytes(out, post_study_css, strlen(post_study_css));
  post_put(out, "</style>\n</head>\n");
}

static void put_lede(const design_study *s, post_buffer *out) {
  post_put(out, "<p class=\"lede\">%d design%s", s->n, s->n == 1 ? "" : "s");
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
  post_put(out, ".</p>\n");
}

static void put_header(const design_study *s, post_buffer *out) {
  post_put(out,
           "<body>\n<a class=\"skip\" href=\"#designs\">To the table</a>\n<header class=\"top\">\n"
           "<p class=\"kicker\">Shrouded blade · design study</p>\n<h1>");
  post_put_escaped(out, name_of(s));
  post_put(out, "</h1>\n");
  put_lede(s, out);
  post_put(out, "<p class=\"headline\">");
  study_headline(s, out);
  post_put(out, "</p>\n");
  study_key_figures(s, out);
  study_findings(s, out);
  post_put(out, "</header>\n");
}

static void put_text(const char *heading, const char *text, post_buffer *out) {
  if (!text || !*text) return;
  post_put(out, "<h3>%s</h3>\n<pre tabindex=\"0\"><code>", heading);
  post_put_escaped(out, text);
  post_put(out, "</code></pre>\n");
}

static void put_source(const design_study *s, post_buffer *out) {
  post_put(out,
           "<section>\n<h2>Study and case</h2>\n<dl class=\"source\">\n<dt>Page made by</dt><dd>");
  post_put_escaped(out, shb_revision());
  post_put(out, "</dd>\n</dl>\n");
  put_text("The study, verbatim", s->text, out);
  put_text("The case, verbatim", s->case_text, out);
  post_put(out, "</section>\n");
}

shb_status study_page(const design_study *s, post_buffer *out) {
  double tolerance;
  char   percent[POST_NUMBER];
  put_head(s, out);
  put_header(s, out);
  post_put(
      out,
      "<main>\n<noscript><p class=\"note\">Charts and table need a script. The CSV file beside "
      "this page holds every number, and the SVG file the chief chart.</p></noscript>\n"
      "<div id=\"charts\"></div>\n");
  put_source(s, out);
  post_put(out, "</main>\n<script type=\"application/json\" id=\"data\">\n");
  SHB_TRY(study_data(s, out, &tolerance));
  post_put(out,
           "\n</script>\n<footer>Curves are drawn to %s of the chart. The CSV beside this page has "
           "every digit. Works without network.</footer>\n<script>\n",
           post_percent(percent, tolerance));
  post_put_bytes(out, post_study_js, strlen(post_study_js));
  post_put(out, "</script>\n</body>\n</html>\n");
  SHB_CHECK(!out->failed, SHB_ERR_IO, "not enough memory for the page of the study");
  return SHB_OK;
}
