/* Messages as data: what a program tells its user also goes to the program that started it, which
 * need not search what was printed. */
#ifndef MESH_PROCESS_REPORT_H
#define MESH_PROCESS_REPORT_H

/* Environment variable with the descriptor that takes the messages. */
#define SHB_REPORT "SHROUDHB_REPORT"

/* Print "shroudhb: error: TEXT" on a line of its own, and report it. */
void shb_error(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Report an error that is printed in another way: one line. Nothing is done where nobody asked. */
void shb_report(const char *line);

/* The same into a place that this program has opened. */
void shb_report_to(int report, const char *line);

/* Let the end at once (mesh/base/crash_guard) report too. Called once, before main. */
void shb_report_join(void);

/* A place for the messages of children and of theirs: the member report of shb_child. It goes with
 * its last descriptor. Negative: there is none. */
int shb_report_open(void);

/* What has been reported, a line each, without the name of the program; malloc'ed. */
char *shb_report_read(int report);

#endif
