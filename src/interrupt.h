/* interrupt.h: Ctrl-C and other signals set flags that long work checks
 *
 * The handlers set a flag and nothing more. In a script a second Ctrl-C ends the program, in case
 * something is stuck; at a prompt only `quit` and the end of input do. */
#ifndef COTREE_SRC_INTERRUPT_H
#define COTREE_SRC_INTERRUPT_H

#include <signal.h>
#include <stdbool.h>

void interrupt_setup(bool interactive);
bool interrupt_asked(void); /* Ctrl-C since interrupt_clear(), or a request to end */
void interrupt_clear(void);
int interrupt_ending(void); /* the SIGTERM or SIGHUP received, or 0 */
/* since the last call: */
bool interrupt_resized(void);   /* the window changed */
bool interrupt_continued(void); /* the program was, after Ctrl-Z */

/* While the program waits for keys, signals are delivered only inside ppoll(): `wait` is the mask
 * for it. */
void interrupt_hold(sigset_t *wait);
void interrupt_release(const sigset_t *wait);
/* in a child, before exec: signals as a program expects them */
void interrupt_forget(void);

#endif
