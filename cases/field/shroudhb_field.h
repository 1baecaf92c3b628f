/* `shroudhb field`: the moving blade of a response, for ParaView and for viewers of glTF. */
#ifndef CASES_FIELD_SHROUDHB_FIELD_H
#define CASES_FIELD_SHROUDHB_FIELD_H

#include "cases/commands/command.h"

/* Returns the exit code. */
int field_command(const command_options *options);

#endif
