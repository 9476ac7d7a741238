/* program.c: a program from outside: making, counting, printing */
#include "compile/program_impl.h"

#include <assert.h>
#include <ctype.h>
#include <string.h>

/* --- the program --- */

Status program_new(const Expr *roots, int root_count, const Expr *inputs, int input_count,
                   Program **out, Diag *diag)
{
    return program_new_in_blocks(roots, root_count, inputs, input_count, NULL, out, diag);
}

Status program_new_in_blocks(const Expr *roots, int root_count, const Expr *inputs, int input_count,
                             const ProgramBlocks *blocks, Program **out, Diag *diag)
{
    Lowered lowered;

    TRY(lowered_make(roots, root_count, inputs, input_count, &lowered, diag));
    *out = program_of(&lowered, blocks);
    return OK;
}

Program *program_of(Lowered *lowered, const ProgramBlocks *blocks)
{
    Program *program = NEW(Program);

    program->input_count = lowered->input_count;
    program->root_count = lowered->root_count;
    program->texts = pool_new(4096);
    program->input_names = NEW_ARRAY(const char *, lowered->input_count);
    for (int i = 0; i < lowered->input_count; i++) {
        const char *name = expr_name(lowered->inputs[i]);

        program->input_names[i] = pool_text(program->texts, name, strlen(name));
    }
    for (int i = 0; i < lowered->tables.count; i++)
        LIST_PUSH(program->tables, curve_copy(lowered->tables.at[i]));
    program_schedule(program, lowered, blocks);
    lowered_free(lowered);
    return program;
}

void program_free(Program *program)
{
    if (program == NULL)
        return;
    mem_free(program->input_names);
    LIST_FREE(program->constants);
    for (int i = 0; i < program->tables.count; i++)
        curve_free(program->tables.at[i]);
    LIST_FREE(program->tables);
    mem_free(program->roots);
    LIST_FREE(program->runs);
    LIST_FREE(program->sections);
    LIST_FREE(program->tape);
    LIST_FREE(program->derived);
    pool_free(program->texts);
    mem_free(program);
}

int program_input_count(const Program *program)
{
    return program->input_count;
}

int program_root_count(const Program *program)
{
    return program->root_count;
}

int program_operations(const Program *program, Stage stage)
{
    int operations = 0;

    for (int r = program->first_run[stage]; r < program->first_run[stage + 1]; r++)
        operations += program->runs.at[r].count;
    return operations;
}

int program_parts(const Program *program, int *operations)
{
    int parts = 1;

    *operations = 0;
    for (int s = 0; s < program->sections.count; s += program->sections.at[s].together) {
        const int together = program->sections.at[s].together;
        const int first = program->sections.at[s].first_run;

        if (together == 1)
            continue;
        parts = together > parts ? together : parts;
        for (int r = first; r < section_end(program, s + together - 1); r++)
            *operations += program->runs.at[r].count;
    }
    return parts;
}

Stage program_last_stage(const Program *program)
{
    Stage last = STAGE_COUNT - 1;

    while (last > STAGE_PARAMETER && program->first_root[last] == program->root_count)
        last--;
    return last;
}

/* --- counting --- */

OpCount program_count(const Program *program)
{
    static const OpCount counts[] = {
#define OPCODE(id, operands, adds, muls, functions, ...) {adds, muls, functions},
#include "compile/opcodes.def"
#undef OPCODE
        [CODE_SINCOS] = {0, 0, 2},
    };
    OpCount total = {0};

    for (int r = 0; r < program->runs.count; r++) {
        const OpcodeRun *run = &program->runs.at[r];
        OpCount one = run->code < CODE_CALL ? counts[run->code] : (OpCount){0, 0, 1};

        total.add += one.add * run->count;
        total.mul += one.mul * run->count;
        total.fun += one.fun * run->count;
    }
    return total;
}

/* --- printing --- */

static void print_slot(Text *text, const Program *program, int slot)
{
    int constant = slot - program->input_count;

    if (constant < 0)
        text_add(text, program->input_names[slot]);
    else if (constant < program->constants.count)
        text_number(text, program->constants.at[constant], 17);
    else
        text_addf(text, "v%d", constant - program->constants.count);
}

/* the row's formula, with operands for a, b, c */
static void print_formula(Text *text, const Program *program, const char *formula,
                          const uint32_t *operand)
{
    for (const char *c = formula; *c != '\0'; c++) {
        bool alone =
            !isalnum((unsigned char)c[1]) && (c == formula || !isalnum((unsigned char)c[-1]));

        if (alone && *c >= 'a' && *c < 'a' + MOST_OPERANDS)
            print_slot(text, program, (int)operand[*c - 'a']);
        else
            text_char(text, *c);
    }
}

static const char *formula_of(Opcode code)
{
    static const char *const formulas[] = {
#define OPCODE(id, operands, adds, muls, functions, ...) #__VA_ARGS__,
#include "compile/opcodes.def"
#undef OPCODE
        [CODE_SINCOS] = "sincos(a)",
    };
    static const char *const calls[] = {"()", "(a)", "(a, b)", "(a, b, c)"};

    return code < CODE_CALL ? formulas[code] : calls[code_operands(code)];
}

static const char *function_of(Opcode code)
{
    static const char *const names[] = {
#define OP(id, name, ...) name,
#include "expr/ops.def"
#undef OP
    };

    return code < CODE_CALL ? "" : names[code - CODE_CALL];
}

void program_print(Text *text, const Program *program)
{
    for (int r = 0; r < program->runs.count; r++) {
        const OpcodeRun *run = &program->runs.at[r];
        int results = run->code == CODE_SINCOS ? 2 : 1;

        for (int i = 0; i < run->count; i++) {
            int slot = run->result + i * results;

            print_slot(text, program, slot);
            if (results == 2) {
                text_add(text, ", ");
                print_slot(text, program, slot + 1);
            }
            text_addf(text, " = %s", function_of(run->code));
            print_formula(text, program, formula_of(run->code),
                          program->tape.at + run->operands + i * code_operands(run->code));
            text_char(text, '\n');
        }
    }
}
