/* print_tree.c: an expression as an indented tree, one node a line; a node that was
 * shown before is only named by its number */
#include "expr/print_impl.h"

typedef struct Branch {
    Expr e;
    int depth;
} Branch;

static void node_line(Text *out, Expr e, int number, bool again)
{
    static const char *const kinds[] = {
        [EXPR_POWER] = "power", [EXPR_PRODUCT] = "product", [EXPR_SUM] = "sum"};

    if (e->count == 0) {
        print_with(out, e, &dialect_text);
        text_char(out, '\n');
        return;
    }
    text_add(out, e->kind == EXPR_CALL ? op_name(e->op) : kinds[e->kind]);
    text_addf(out, again ? " #%d above\n" : " #%d\n", number);
}

void print_tree(Text *out, Expr e)
{
    LIST(Branch) stack = {0};
    Walk shown = {0};

    LIST_PUSH(stack, (Branch){e, 0});
    while (stack.count > 0) {
        Branch branch = stack.at[--stack.count];
        bool again = walk_find(&shown, branch.e) >= 0;
        int number = branch.e->count > 0 ? 1 + walk_add(&shown, branch.e) : 0;

        text_fill(out, ' ', 2 * branch.depth);
        node_line(out, branch.e, number, again);
        if (again)
            continue;
        for (int i = branch.e->count - 1; i >= 0; i--)
            LIST_PUSH(stack, (Branch){node_args(branch.e)[i], branch.depth + 1});
    }
    walk_free(&shown);
    LIST_FREE(stack);
}
