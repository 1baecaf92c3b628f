#!/bin/sh
# test_reference.sh SHROUDHB PAGE: the case reference is what the key table says.
if "$1" keys --markdown | diff - "$2"; then exit 0; fi
echo "run: shroudhb keys --markdown > docs/user/case_reference.md" >&2
exit 1
