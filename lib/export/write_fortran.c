/* write_fortran.c: a model as a module of Fortran 2008 */
#include "export/code.h"
#include "present/fortran_lines.h"

#include <string.h>

/* names of locals on lines of their own */
static void add_locals(Text *out, const char *locals)
{
    enum { ON_A_LINE = 6 };
    int count = 0;

    for (const char *c = locals; *c != '\0'; count++) {
        const size_t length = strcspn(c, ",");

        if (count % ON_A_LINE == 0)
            text_addf(out, "%s    real(wp) :: ", count > 0 ? "\n" : "");
        text_addf(out, "%s%.*s", count % ON_A_LINE > 0 ? ", " : "", (int)length, c);
        c += length;
        c += strspn(c, ", ");
    }
    if (count > 0)
        text_char(out, '\n');
}

static void open_function(Text *out, const Code *code, const CodeFunction *f, const char *locals)
{
    (void)code;
    text_addf(out,
              "\n! %s\nsubroutine model_%s(p, t, y, s, out)\n"
              "    real(wp), intent(in) :: p(:), t, y(:), s(:)\n"
              "    real(wp), intent(out) :: out(%s)\n",
              f->what, f->name, f->is_matrix ? ":, :" : ":");
    add_locals(out, locals);
    text_add(out, "\n    out = 0\n");
}

static const char head[] =
    "$HEAD"
    "module model\nuse, intrinsic :: iso_fortran_env, only: wp => real64\nimplicit none\n\n"
    "integer, parameter :: model_parameters_n = $PARAMETERS, model_p = $NP, model_q = $Q, "
    "model_u = $U\n"
    "integer, parameter :: model_x = $X, model_a = $A, model_y = $Y, model_z = $Z, model_m = $M\n"
    "integer, parameter :: model_s = $S, model_outputs_n = $OUTPUTS, model_conditions_n = "
    "$CONDITIONS\n"
    "integer, parameter :: model_ok = 0, model_singular = 1, model_no_solution = 2, model_left = "
    "3\n";

static const char ideals[] =
    "integer, parameter :: model_ideals = $IDEALS, model_edges_n = $EDGES\n"
    "integer, parameter :: model_closed = $CLOSED ! where p has the sides of\n$IDEALNAMES";

static const char sampled[] = "integer, parameter :: model_sampled(*) = [$SAMPLED] ! in y\n";

static const char interfaces[] =
    "\nabstract interface\n    subroutine model_rows(p, t, y, s, out)\n        import :: wp\n"
    "        real(wp), intent(in) :: p(:), t, y(:), s(:)\n"
    "        real(wp), intent(out) :: out(:, :)\n    end subroutine\nend interface\n\ncontains\n";

static const char tables[] =
    "\n! a spline through data, or a derivative of it\n"
    "pure function model_table(number, v, order) result(value)\n"
    "    integer, intent(in) :: number, order\n    real(wp), intent(in) :: v\n"
    "    real(wp) :: value, h, a, b\n    real(wp), allocatable :: d(:)\n"
    "    integer :: n, i\n\n    n = 0\n    select case (number)\n$TABLES"
    "    end select\n    if (v < d(1) .or. v > d(n)) then\n"
    "        value = merge(0.0_wp, merge(d(n + 1), d(2*n), v < d(1)), order > 0)\n"
    "        return\n    end if\n    i = min(max(count(d(1:n) <= v), 1), n - 1)\n"
    "    h = d(i + 1) - d(i)\n    a = (d(i + 1) - v)/h\n    b = (v - d(i))/h\n"
    "    select case (order)\n    case (0)\n"
    "        value = a*d(n + i) + b*d(n + i + 1) + &\n"
    "            ((a**3 - a)*d(2*n + i) + (b**3 - b)*d(2*n + i + 1))*h*h/6\n    case (1)\n"
    "        value = (d(n + i + 1) - d(n + i))/h + &\n"
    "            ((3*b*b - 1)*d(2*n + i + 1) - (3*a*a - 1)*d(2*n + i))*h/6\n    case (2)\n"
    "        value = a*d(2*n + i) + b*d(2*n + i + 1)\n    case (3)\n"
    "        value = (d(2*n + i + 1) - d(2*n + i))/h\n    case default\n"
    "        value = 0\n    end select\nend function\n";

static const char values[] =
    "\n! what follows from parameters alone: after one has changed\n"
    "subroutine model_prepare(p)\n    real(wp), intent(inout) :: p(:)\n$PREPARE"
    "end subroutine\n\n! their values, with model_prepare()\n"
    "subroutine model_parameters(p)\n    real(wp), intent(out) :: p(:)\n\n    p = 0\n$VALUES"
    "    call model_prepare(p)\nend subroutine\n\n! initial conditions, and s there\n"
    "subroutine model_start(y, s)\n    real(wp), intent(out) :: y(:), s(:)\n\n    s = 0\n$START"
    "end subroutine\n$CODE";

static const char partial_pivots[] =
    "\n! A x = b from the rows [A | b]: elimination with row pivots\n"
    "subroutine model_eliminate(rows, x, status)\n    real(wp), intent(in) :: rows(:, :)\n"
    "    real(wp), intent(out) :: x(:)\n    integer, intent(out) :: status\n"
    "    real(wp) :: a(size(rows, 1), size(rows, 2)), scales(size(rows, 1)), line(size(rows, 2))\n"
    "    integer :: n, i, k, pivot\n\n    n = size(rows, 1)\n    a = rows\n    x = 0\n"
    "    status = model_singular\n    do i = 1, n\n"
    "        if (.not. maxval(abs(a(i, 1:n))) > 0) return\n"
    "        a(i, :) = a(i, :)/maxval(abs(a(i, 1:n)))\n    end do\n    do k = 1, n\n"
    "        scales(k) = maxval(abs(a(:, k)))\n        if (.not. scales(k) > 0) return\n"
    "        a(:, k) = a(:, k)/scales(k)\n    end do\n    do k = 1, n\n"
    "        pivot = k - 1 + maxloc(abs(a(k:n, k)), 1)\n"
    "        if (.not. abs(a(pivot, k)) > 1e-14_wp) return\n        line = a(k, :)\n"
    "        a(k, :) = a(pivot, :)\n        a(pivot, :) = line\n        do i = k + 1, n\n"
    "            if (abs(a(i, k)) > 0) a(i, k + 1:) = a(i, k + 1:) - a(i, k)/a(k, k)*a(k, k + 1:)\n"
    "        end do\n    end do\n    do i = n, 1, -1\n"
    "        x(i) = (a(i, n + 1) - dot_product(a(i, i + 1:n), x(i + 1:n)))/a(i, i)\n    end do\n"
    "    x = x/scales\n    status = model_ok\nend subroutine\n";

static const char full_pivots[] =
    "\n! A x = b from the rows [A | b]: elimination with full pivots. Constraints repeat each "
    "other:\n"
    "! of all solutions the least x\n"
    "subroutine model_eliminate(rows, x, status)\n    real(wp), intent(in) :: rows(:, :)\n"
    "    real(wp), intent(out) :: x(:)\n    integer, intent(out) :: status\n"
    "    real(wp) :: a(size(rows, 1), size(rows, 2)), scales(size(rows, 1)), line(size(rows, 2))\n"
    "    real(wp) :: column(size(rows, 1)), null(size(rows, 1), size(rows, 1)), v(size(rows, 1))\n"
    "    integer :: order(size(rows, 1)), place(2), n, i, k, c, rank\n\n"
    "    n = size(rows, 1)\n    a = rows\n    status = model_ok\n    rank = n\n    do i = 1, n\n"
    "        if (maxval(abs(a(i, 1:n))) > 0) a(i, :) = a(i, :)/maxval(abs(a(i, 1:n)))\n"
    "        order(i) = i\n    end do\n    do k = 1, n\n        scales(k) = maxval(abs(a(:, k)))\n"
    "        if (.not. scales(k) > 0) scales(k) = 1\n        a(:, k) = a(:, k)/scales(k)\n"
    "    end do\n    do k = 1, n\n        place = k - 1 + maxloc(abs(a(k:n, k:n)))\n"
    "        if (.not. abs(a(place(1), place(2))) > 1e-10_wp) then\n            rank = k - 1\n"
    "            exit\n        end if\n        line = a(k, :)\n        a(k, :) = a(place(1), :)\n"
    "        a(place(1), :) = line\n        column = a(:, k)\n        a(:, k) = a(:, place(2))\n"
    "        a(:, place(2)) = column\n        i = order(k)\n        order(k) = order(place(2))\n"
    "        order(place(2)) = i\n        do i = k + 1, n\n"
    "            a(i, k + 1:) = a(i, k + 1:) - a(i, k)/a(k, k)*a(k, k + 1:)\n        end do\n"
    "    end do\n    ! what A takes to nothing; last, a solution\n    do c = rank + 1, n + 1\n"
    "        v = 0\n        if (c <= n) v(c) = 1\n        do i = rank, 1, -1\n"
    "            v(i) = (merge(-a(i, c), a(i, c), c <= n) - dot_product(a(i, i + 1:rank), v(i + "
    "1:rank)))/a(i, i)\n        end do\n        column(order) = v\n        v = column/scales\n"
    "        do k = 1, c - rank - 1\n            v = v - dot_product(null(:, k), v)*null(:, k)\n"
    "        end do\n        if (c <= n) null(:, c - rank) = v/norm2(v)\n    end do\n    x = v\n"
    "end subroutine\n";

static const char newton[] =
    "\n! Newton's method, its steps shortened where they lead away. Where the full step is next to "
    "nothing\n"
    "! and does not halve the residual, rounding hides what is left: s is the solution.\n"
    "subroutine model_newton(rows, p, t, y, s, first, n, status)\n"
    "    procedure(model_rows) :: rows\n    real(wp), intent(in) :: p(:), t, y(:)\n"
    "    real(wp), intent(inout) :: s(:)\n    integer, intent(in) :: first, n\n"
    "    integer, intent(out) :: status\n"
    "    real(wp) :: a(n, n + 1), weight(n), x(n), old(n), lack, after, part\n"
    "    integer :: tries, halves, near\n\n    near = 0\n    do tries = 1, 200\n"
    "        call rows(p, t, y, s, a)\n        weight = maxval(abs(a(:, 1:n)), 2)\n"
    "        lack = sum(abs(a(:, n + 1))/weight)\n"
    "        if (.not. lack - lack <= 0) then ! no number: s stays one that can be gone on from\n"
    "            if (tries > 1) s(first:first + n - 1) = old\n            exit\n        end if\n"
    "        call model_eliminate(a, x, status)\n"
    "        if (status /= model_ok) return\n        old = s(first:first + n - 1)\n"
    "        part = 1\n        after = 0\n        do halves = 1, 60\n"
    "            s(first:first + n - 1) = old + part*x\n"
    "            if (near > 0 .or. .not. lack > 0) exit\n            call rows(p, t, y, s, a)\n"
    "            after = sum(abs(a(:, n + 1))/weight)\n            if (after < lack) exit\n        "
    "    part = part/2\n"
    "        end do\n"
    "        if (near == 0 .and. after > lack/2 .and. maxval(abs(x)) <= 1e-12_wp) return\n"
    "        if (maxval(abs(x)) <= 1e-9_wp*maxval(abs(old)) .or. .not. lack > 0) near = near + 1\n"
    "        if (near > 2) return\n    end do\n    status = model_no_solution\nend subroutine\n";

static const char after[] =
    "$SOLVE\n! y' and s\nsubroutine model_rates(p, t, y, s, rates, status)\n"
    "    real(wp), intent(in) :: p(:), t, y(:)\n    real(wp), intent(inout) :: s(:)\n"
    "    real(wp), intent(out) :: rates(:)\n    integer, intent(out) :: status\n\n"
    "    call model_solve(p, t, y, s, status)\n    call model_derivative(p, t, y, s, rates)\n"
    "end subroutine\n"
    "\nsubroutine model_nearest(p, t, y, b, x, status)\n"
    "    real(wp), intent(in) :: p(:), t, y(:), b(:)\n    real(wp), intent(out) :: x(:)\n"
    "    integer, intent(out) :: status\n"
    "    real(wp) :: phi_u(model_m, model_u), a(model_u + model_m, model_u + model_m + 1)\n"
    "    real(wp) :: all(model_u + model_m)\n    integer :: i\n\n"
    "    call model_jacobian(p, t, y, y, phi_u)\n    a = 0\n    do i = 1, model_u\n"
    "        a(i, i) = 1\n    end do\n    a(model_u + 1:, 1:model_u) = phi_u\n"
    "    a(1:model_u, model_u + 1:model_u + model_m) = transpose(phi_u)\n"
    "    a(model_u + 1:, model_u + model_m + 1) = b\n    call model_eliminate(a, all, status)\n"
    "    x = all(1:model_u)\nend subroutine\n"
    "\nsubroutine model_normalise(y)\n    real(wp), intent(inout) :: y(:)\n    integer :: k\n"
    "    integer, parameter :: first($QUATERNIONS) = [integer :: $FIRSTS]\n\n"
    "    do k = 1, size(first)\n"
    "        y(first(k):first(k) + 3) = y(first(k):first(k) + 3)/norm2(y(first(k):first(k) + 3))\n"
    "    end do\nend subroutine\n"
    "\n! y onto the constraints: positions, then speeds\n"
    "subroutine model_project(p, t, y, status)\n    real(wp), intent(in) :: p(:), t\n"
    "    real(wp), intent(inout) :: y(:)\n    integer, intent(out) :: status\n"
    "    real(wp) :: b(model_m), phi_u(model_m, model_u), map(model_q, model_u), du(model_u)\n"
    "    real(wp) :: turned(model_a)\n    integer :: sweep\n\n    status = model_ok\n"
    "    call model_normalise(y)\n    if (model_m > 0) then\n        do sweep = 1, 20\n"
    "            call model_constraints(p, t, y, y, b)\n"
    "            if (maxval(abs(b)) <= 1e-13_wp) exit\n"
    "            call model_nearest(p, t, y, -b, du, status)\n"
    "            if (status /= model_ok) return\n            call model_map(p, t, y, y, map)\n"
    "            y(1:model_q) = y(1:model_q) + matmul(map, du)\n"
    "            call model_normalise(y)\n        end do\n"
    "        call model_velocity(p, t, y, y, b)\n        call model_jacobian(p, t, y, y, phi_u)\n"
    "        b = b - matmul(phi_u, y(model_q + 1:model_q + model_u))\n"
    "        call model_nearest(p, t, y, b, du, status)\n"
    "        y(model_q + 1:model_q + model_u) = y(model_q + 1:model_q + model_u) + du\n"
    "    end if\n    if (model_a > 0) then\n        call model_angles(p, t, y, y, turned)\n"
    "        y(model_q + model_u + model_x + 1:) = turned\n    end if\nend subroutine\n"
    "\n! one step of the classical Runge-Kutta method, with projection\n"
    "subroutine model_$SMOOTH(p, t, h, y, s, status)\n    real(wp), intent(in) :: p(:), t, h\n"
    "    real(wp), intent(inout) :: y(:), s(:)\n    integer, intent(out) :: status\n"
    "    real(wp), dimension(model_y) :: k1, k2, k3, k4\n\n"
    "    call model_rates(p, t, y, s, k1, status)\n    if (status /= model_ok) return\n"
    "    call model_rates(p, t + h/2, y + h/2*k1, s, k2, status)\n"
    "    if (status /= model_ok) return\n"
    "    call model_rates(p, t + h/2, y + h/2*k2, s, k3, status)\n"
    "    if (status /= model_ok) return\n"
    "    call model_rates(p, t + h, y + h*k3, s, k4, status)\n"
    "    if (status /= model_ok) return\n    y = y + h/6*(k1 + 2*k2 + 2*k3 + k4)\n"
    "    call model_project(p, t + h, y, status)\nend subroutine\n";

/* in the mode of ideal parts that p has, which code in this language doesn't leave by itself */
static const char step_in_mode[] =
    "\n! model_left where an ideal part is on the other side than p has it\n"
    "subroutine model_hold_sides(p, t, y, s, status)\n"
    "    real(wp), intent(in) :: p(:), t, y(:), s(:)\n    integer, intent(out) :: status\n"
    "    real(wp) :: look(model_ideals, 4), edge(model_edges_n, 2), most(2)\n"
    "    logical :: closed, wrong\n    integer :: k\n\n    status = model_ok\n"
    "    call model_looks(p, t, y, s, look)\n    call model_edges(p, t, y, s, edge)\n"
    "    most = 1e-9_wp*maxval(abs(edge), dim=1)\n    do k = 1, model_ideals\n"
    "        closed = p(model_closed + k - 1) > 0.5_wp\n"
    "        if (look(k, 3) >= 0) then\n            wrong = look(k, 3) > 0.5_wp .neqv. closed\n"
    "        else if (closed) then\n            wrong = look(k, 1) < -most(1)\n"
    "        else\n            wrong = look(k, 2) > most(2)\n        end if\n"
    "        if (wrong) status = model_left\n    end do\nend subroutine\n"
    "\n! model_smooth_step; where an ideal part goes over on the way it is model_left, and y "
    "stays:\n"
    "! p has the mode, which export c changes by itself\n"
    "subroutine model_$STEP(p, t, h, y, s, status)\n    real(wp), intent(in) :: p(:), t, h\n"
    "    real(wp), intent(inout) :: y(:), s(:)\n    integer, intent(out) :: status\n"
    "    real(wp) :: before(model_y)\n\n    before = y\n"
    "    call model_smooth_step(p, t, h, y, s, status)\n"
    "    if (status == model_ok) call model_solve(p, t + h, y, s, status)\n"
    "    if (status == model_ok) call model_hold_sides(p, t + h, y, s, status)\n"
    "    if (status /= model_ok) y = before\nend subroutine\n";

/* steps over sampling instants, whole multiples of the periods */
static const char sampled_step[] =
    "\n! the sampled states that are due at t\n"
    "subroutine model_sample(p, t, y, s, status)\n    real(wp), intent(in) :: p(:), t\n"
    "    real(wp), intent(inout) :: y(:), s(:)\n    integer, intent(out) :: status\n"
    "    real(wp), dimension(size(model_sampled)) :: period, next\n"
    "    logical, dimension(size(model_sampled)) :: due\n\n    status = model_ok\n"
    "    call model_periods(p, t, y, s, period)\n"
    "    due = abs(t/period - anint(t/period)) <= 1e-9_wp\n    if (.not. any(due)) return\n"
    "    call model_solve(p, t, y, s, status)\n    if (status /= model_ok) return\n"
    "    call model_samples(p, t, y, s, next)\n"
    "    y(model_sampled) = merge(next, y(model_sampled), due)\nend subroutine\n"
    "\n! model_step_between over sampling instants; one at its end is the next step's\n"
    "subroutine model_step(p, t, h, y, s, status)\n    real(wp), intent(in) :: p(:), t, h\n"
    "    real(wp), intent(inout) :: y(:), s(:)\n    integer, intent(out) :: status\n"
    "    real(wp), dimension(size(model_sampled)) :: period, instant\n"
    "    real(wp) :: now, until\n\n    status = model_ok\n    now = t\n"
    "    call model_periods(p, t, y, s, period)\n"
    "    do while (status == model_ok .and. now < t + h)\n"
    "        instant = period*(floor(now/period + 1e-9_wp) + 1)\n"
    "        until = minval(merge(instant, t + h, instant < t + h - 1e-9_wp*period))\n"
    "        call model_sample(p, now, y, s, status)\n        if (status == model_ok) &\n"
    "            call model_step_between(p, now, until - now, y, s, status)\n"
    "        now = until\n    end do\nend subroutine\n";

static const char check[] =
    "\nend module\n"
    "\n#ifdef MODEL_CHECK\nprogram check\nuse model\nimplicit none\n"
    "real(wp) :: p(model_p), y(model_y), s(model_s), right(model_s), t, worst\n"
    "real(wp) :: sums(2, $FUNCTIONS), sizes(4)\ninteger :: bad, at, parts(4), part, i, k, "
    "status\n\n"
    "call model_parameters(p)\nworst = 0\nbad = 0\nparts = [model_x, model_z, model_u, "
    "model_m]\nsizes = $SIZES\n"
    "do k = 1, $STATES\n    call state(k, t, y, right, sums)\n"
    "    s = right*(1 + 1e-3_wp) ! a guess that is near\n"
    "    call model_solve(p, t, y, s, status)\n    if (status /= model_ok) bad = bad + 1\n"
    "    at = 0\n    do part = 1, 4\n        do i = at + 1, at + parts(part)\n"
    "            call compare(s(i), right(i), sizes(part))\n        end do\n"
    "        at = at + parts(part)\n    end do\n    do i = 1, model_y ! away from the constraints\n"
    "        y(i) = y(i)*(1 + (mod(i - 1, 5) + 1)/32.0_wp)\n    end do\n$SUMS"
    "end do\nprint '(i0, 3a, es8.1, a)', $STATES, ' states: ', &\n"
    "    merge('all as they were', 'NOT as they were', bad == 0), ', off by', worst, ' at most'\n"
    "if (bad > 0) error stop\n\ncontains\n"
    "\nsubroutine compare(found, should, scale)\n"
    "    real(wp), intent(in) :: found, should, scale\n    real(wp) :: off\n\n"
    "    off = abs(found - should)/merge(scale, 1.0_wp, scale > 0)\n"
    "    worst = max(worst, off)\n    if (.not. off <= 1e-12_wp) bad = bad + 1\nend subroutine\n"
    "\nfunction total(v) result(value)\n    real(wp), intent(in) :: v(:)\n"
    "    real(wp) :: value\n    integer :: j\n\n    value = 0\n    do j = 1, size(v)\n"
    "        value = value + (1 + mod(j - 1, 7))*v(j)\n    end do\nend function\n"
    "\nsubroutine state(k, t, y, s, sums)\n    integer, intent(in) :: k\n"
    "    real(wp), intent(out) :: t, y(model_y), s(model_s), sums(:, :)\n\n"
    "    select case (k)\n$CASES    end select\nend subroutine\nend program\n#endif\n";

static void write_solve(const Code *code, const Language *language, Text *out)
{
    const int first = code->layout->nx + code->layout->nz;

    (void)language;
    text_add(out, "\n! s for a state; s as it was is where Newton's method begins\n"
                  "subroutine model_solve(p, t, y, s, status)\n"
                  "    real(wp), intent(in) :: p(:), t, y(:)\n"
                  "    real(wp), intent(inout) :: s(:)\n    integer, intent(out) :: status\n");
    for (int g = 0; g < code->group_count; g++)
        if (!code->groups[g].iterates)
            text_addf(out, "    real(wp) :: a%d(%d, %d), x%d(%d)\n", g + 1, code->groups[g].count,
                      code->groups[g].count + 1, g + 1, code->groups[g].count);
    if (code->is_explicit)
        text_addf(out, "    real(wp) :: du(%d)\n", code->ns - first);
    text_add(out, "\n    status = model_ok\n");
    for (int g = 0; g < code->group_count; g++) {
        const CodeGroup *group = &code->groups[g];
        const char *name = code->functions.at[group->function].name;

        if (group->iterates)
            text_addf(out, "    call model_newton(model_%s, p, t, y, s, %d, %d, status)\n", name,
                      group->first + 1, group->count);
        else
            text_addf(out,
                      "    call model_%s(p, t, y, s, a%d)\n"
                      "    call model_eliminate(a%d, x%d, status)\n    s(%d:%d) = x%d\n",
                      name, g + 1, g + 1, g + 1, group->first + 1, group->first + group->count,
                      g + 1);
        text_add(out, "    if (status /= model_ok) return\n");
    }
    if (code->is_explicit)
        text_addf(out,
                  "    call model_accelerations(p, t, y, s, du)\n    s(%d:) = du\n"
                  "    if (.not. all(abs(du) < huge(1.0_wp))) status = model_singular\n",
                  first + 1);
    text_add(out, "end subroutine\n");
}

/* each function's sum in a state */
static void write_sums(const Code *code, const Language *language, Text *out)
{
    (void)language;
    for (int f = 0; f < code->functions.count; f++) {
        const CodeFunction *function = &code->functions.at[f];
        const int entries = function->rows * function->columns;

        if (entries == 0)
            continue;
        text_add(out, "    block\n        real(wp) :: out(");
        if (function->is_matrix)
            text_addf(out, "%d, %d)\n", function->rows, function->columns);
        else
            text_addf(out, "%d)\n", function->rows);
        text_addf(out,
                  "        call model_%s(p, t, y, right, out)\n"
                  "        call compare(total(%s), sums(1, %d), sums(2, %d))\n    end block\n",
                  function->name,
                  function->is_matrix ? "reshape(transpose(out), [size(out)])" : "out", f + 1,
                  f + 1);
    }
}

static void write_tables(const Code *code, const Language *language, Text *out)
{
    for (int i = 0; i < code->lowered.tables.count; i++) {
        const Curve *curve = code->lowered.tables.at[i];

        text_addf(out, "    case (%d)\n    n = %d\n    allocate(d(3*n))\n", i + 1, curve->count);
        code_set_array(language, "d", curve->data, 3 * curve->count, out);
    }
}

/* the names that the lines make come first */
static void write_prepare(const Code *code, const Language *language, Text *out)
{
    Text derived = {0};
    char *locals = code_print_derived(code, language, &derived);

    add_locals(out, locals);
    text_addf(out, "\n%s", derived.at != NULL ? derived.at : "");
    mem_free(locals);
    text_free(&derived);
}

static const CodeWord words[] = {{"TABLES", write_tables},
                                 {"PREPARE", write_prepare},
                                 {"SOLVE", write_solve},
                                 {"SUMS", write_sums},
                                 {NULL, NULL}};

static const CodeText texts[] = {{head, CODE_ALWAYS},
                                 {ideals, CODE_WITH_MODES},
                                 {sampled, CODE_WITH_SAMPLES},
                                 {interfaces, CODE_ALWAYS},
                                 {tables, CODE_WITH_TABLES},
                                 {values, CODE_ALWAYS},
                                 {full_pivots, CODE_WITH_REDUNDANCE},
                                 {partial_pivots, CODE_WITHOUT_REDUNDANCE},
                                 {newton, CODE_ALWAYS},
                                 {after, CODE_ALWAYS},
                                 {step_in_mode, CODE_WITH_MODES},
                                 {sampled_step, CODE_WITH_SAMPLES},
                                 {check, CODE_ALWAYS},
                                 {NULL, CODE_ALWAYS}};

const Language language_fortran = {
    .notation = NOTATION_FORTRAN,
    .array = "%s(%d)",
    .matrix = "%s(%d, %d)",
    .local = "%s = %s",
    .result = "%s = %s",
    .onward = "&",
    .number = "%s_wp",
    .power = {"(", "**", ")"},
    .open = open_function,
    .close = "end subroutine\n",
    .check = "gfortran -cpp -frecursive -DMODEL_CHECK FILE.f90 && ./a.out",
    .between = ", &\n    ",
    .ideal = {"! %s\n", ""},
    .state = "    case (%d)\n",
    .sums = "sums(:, %d)",
    .words = words,
    .texts = texts,
    .wrap = fortran_wrap,
};
