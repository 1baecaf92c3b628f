/* Branches of one response taken over by another. */
#include <string.h>

#include "mhb/response/response.h"

shb_status mhb_response_merge(mhb_response *response, mhb_response *other) {
  SHB_CHECK(response->n_pairs == other->n_pairs && response->n_probes == other->n_probes &&
                response->subharmonics == other->subharmonics &&
                response->n_interfaces == other->n_interfaces &&
                response->parameter == other->parameter,
            SHB_ERR_INPUT,
            "%d pairs, %d probes, subharmonics %d do not go with %d, %d, %d; make both files from "
            "one case",
            other->n_pairs, other->n_probes, other->subharmonics, response->n_pairs,
            response->n_probes, response->subharmonics);
  int before = response->n_branches, index;
  for (int i = 0; i < other->n_branches; i++) {
    mhb_branch *branch = &other->branch[i];
    SHB_TRY(mhb_response_branch(response, branch->kind, &index));
    response->branch[index] = *branch;
    response->branch[index].main += before;
    memset(branch, 0, sizeof *branch);
  }
  other->n_branches = 0;
  if (other->n_lines > response->n_lines) response->n_lines = other->n_lines;
  return SHB_OK;
}
