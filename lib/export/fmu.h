/* fmu.h: a model as a Functional Mock-up Unit, for other simulators (fmi-standard.org)
 *
 * An archive of a description in XML, of code in C, and of a binary that whoever writes the file
 * adds. The code is that of code_live.c with an instance around it (share/fmu). */
#ifndef COTREE_EXPORT_FMU_H
#define COTREE_EXPORT_FMU_H

#include "export/archive.h"
#include "export/code.h"

/* modelDescription.xml (fmu_description.c); `token` identifies the code that it belongs to */
void fmu_describe(const Code *code, const Exported *what, const char *token, Text *out);
#define FMU_IDENTIFIER "model" /* of binaries */
#define FMU_TOLERANCE  "1e-6"  /* where an importer names none */

#endif
