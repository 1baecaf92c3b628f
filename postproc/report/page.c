#include "postproc/report/page.h"

#include <string.h>

void post_page_open(const char *name, const char *subject, post_buffer *out) {
  post_put(out,
           "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
           "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
           "'unsafe-inline'; script-src 'unsafe-inline'; img-src data:\">\n<title>");
  post_put_escaped(out, name);
  post_put(out, " · %s</title>\n<style>\n", subject);
  post_put_bytes(out, post_page_css, strlen(post_page_css));
}
