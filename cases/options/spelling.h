/* How far a word is from the one that was meant. */
#ifndef CASES_OPTIONS_SPELLING_H
#define CASES_OPTIONS_SPELLING_H

enum { CASE_LONGEST_WORD = 64 };

/* Number of edits that turn a into b: insert, delete, replace, swap neighbours. Case is ignored. */
int case_edit_distance(const char *a, const char *b);

#endif
