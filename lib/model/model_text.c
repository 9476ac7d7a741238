/* model_text.c: what a model knows of an expression's text */
#include "base/memory.h"
#include "model/model.h"

bool model_text_dimension(const Model *model, const char *text, Dimension *out)
{
    Pool *pool = pool_new(1024);
    Syntax *syntax = NULL;
    const bool found = syntax_parse_expression(text, pool, &syntax, NULL) == OK &&
                       model_dimension(model, syntax, out);

    pool_free(pool);
    return found;
}
