/* greek.c: names of Greek letters; the capitals are those that look unlike Latin ones */
#include "expr/greek.h"

#include "base/memory.h"

#include <string.h>

/* clang-format off */
static const Greek letters[] = {
    {"alpha", "α"}, {"beta", "β"}, {"gamma", "γ"}, {"delta", "δ"}, {"epsilon", "ε"}, {"zeta", "ζ"},
    {"eta", "η"}, {"theta", "θ"}, {"iota", "ι"}, {"kappa", "κ"}, {"lambda", "λ"}, {"mu", "μ"},
    {"nu", "ν"}, {"xi", "ξ"}, {"pi", "π"}, {"rho", "ρ"}, {"sigma", "σ"}, {"tau", "τ"},
    {"upsilon", "υ"}, {"phi", "φ"}, {"chi", "χ"}, {"psi", "ψ"}, {"omega", "ω"},
    {"Gamma", "Γ"}, {"Delta", "Δ"}, {"Theta", "Θ"}, {"Lambda", "Λ"}, {"Xi", "Ξ"}, {"Pi", "Π"},
    {"Sigma", "Σ"}, {"Phi", "Φ"}, {"Psi", "Ψ"}, {"Omega", "Ω"},
};
/* clang-format on */

const Greek *greek_find(const char *name, size_t length)
{
    for (int i = 0; i < COUNT(letters); i++) {
        if (strlen(letters[i].name) == length && strncmp(letters[i].name, name, length) == 0)
            return &letters[i];
    }
    return NULL;
}
