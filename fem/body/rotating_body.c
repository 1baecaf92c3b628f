#include "fem/body/rotating_body.h"

#include <string.h>

void fem_body_element(const fem_body *body, int element, const double *u, double x[][3],
                      double v[][3]) {
  const int  n     = body->element->n;
  const int *nodes = body->mesh->connectivity + n * (size_t)element;
  for (int i = 0; i < n; i++) {
    size_t node = 3 * (size_t)nodes[i];
    memcpy(x[i], body->mesh->coordinates + node, sizeof x[i]);
    if (u)
      memcpy(v[i], u + node, sizeof v[i]);
    else
      memset(v[i], 0, sizeof v[i]);
  }
}
