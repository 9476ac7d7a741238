"""cotree in Python: sessions of statements, and models as functions of numbers.

    import cotree
    session = cotree.Session()
    session.run('body b mass=1 inertia=[1, 1, 1]; ...; simulate 2')
    print(session.value('h at 1'))
    values, units = session.columns('h h\'')
    model = session.model(derivatives='derivative')
    p, y, s = model.start()
    rates, s = model.evaluator().rates(p, 0, y, s)

What goes wrong is raised as cotree.Error, with the place in the text. Where numpy is there, arrays
come out as its arrays, else as lists of lists, row by row. See the chapter 'The library' of the
manual, and cotree.h. The library is found where the system has it, or where COTREE_LIBRARY says.
"""
import ctypes
import ctypes.util
import os
from ctypes import (CFUNCTYPE, POINTER, byref, c_bool, c_char, c_char_p, c_double, c_int, c_int64,
                    c_size_t, c_void_p)

try:
    import numpy
except ImportError:
    numpy = None

_OK, _STOPPED, _NOT_MINE = 0, 2, 4
_MODEL, _SESSION = 0, 1  # who carries a statement out
PARAMETERS, STATE, SOLUTION, OUTPUTS = range(4)


class _Error(ctypes.Structure):
    _fields_ = [('status', c_int), ('line', c_int), ('column', c_int), ('width', c_int),
                ('message', c_char * 600), ('hint', c_char * 400), ('inside', c_char * 300),
                ('is_unsolved', c_bool)]


class _Cursor(ctypes.Structure):
    _fields_ = [('text', c_char_p), ('next', c_size_t), ('line', c_int), ('line_start', c_size_t)]


class _ModelOptions(ctypes.Structure):
    _fields_ = [('outputs', POINTER(c_void_p)), ('output_count', c_int),
                ('derivatives', c_char_p), ('lanes', c_int)]


_SeeRow = CFUNCTYPE(c_bool, c_void_p, c_double, POINTER(c_double))
_SetInput = CFUNCTYPE(c_bool, c_void_p, c_char_p, c_double, POINTER(c_double), POINTER(c_double))


class _RunOptions(ctypes.Structure):
    _fields_ = [('resumes', c_bool), ('duration', c_double), ('every', c_double),
                ('rtol', c_double), ('atol', c_double), ('step', c_double),
                ('maxstep', c_double), ('method', c_char_p), ('check', c_bool),
                ('realtime', c_bool), ('items', POINTER(c_void_p)), ('item_count', c_int),
                ('context', c_void_p), ('row', _SeeRow), ('input', _SetInput)]


class _Figures(ctypes.Structure):
    _fields_ = [('method', c_char_p), ('rows', c_int), ('from', c_double), ('to', c_double),
                ('rtol', c_double), ('atol', c_double), ('steps', c_int64), ('rejected', c_int64),
                ('evaluations', c_int64), ('position_residual', c_double),
                ('velocity_residual', c_double), ('energy_drift', c_double),
                ('energy_scale', c_double), ('global_error', c_double), ('wall', c_double),
                ('stopped', c_bool)]


class _Column(ctypes.Structure):
    _fields_ = [('name', c_char_p), ('unit', c_char_p), ('values', POINTER(c_double))]


def _load():
    library = ctypes.CDLL(os.environ.get('COTREE_LIBRARY') or
                          ctypes.util.find_library('cotree') or 'libcotree.so.0')
    numbers, place = POINTER(c_double), POINTER(c_int)
    text = POINTER(c_void_p)  # of new strings, which are freed
    error = POINTER(_Error)
    for name, result, *arguments in (
            ('version', c_char_p),
            ('free', None, c_void_p),
            ('words_free', None, c_void_p),
            ('session_new', c_void_p, c_void_p),
            ('session_free', None, c_void_p),
            ('parse', c_int, POINTER(_Cursor), c_bool, text, error),
            ('statement_free', None, c_void_p),
            ('statement_is_empty', c_bool, c_void_p),
            ('carrier', c_int, c_void_p),
            ('verb', c_char_p, c_void_p),
            ('operand_count', c_int, c_void_p),
            ('operand', c_void_p, c_void_p, c_int),
            ('at', c_void_p, c_void_p),
            ('apply', c_int, c_void_p, c_void_p, error),
            ('run', c_int, c_void_p, c_void_p, error),
            ('report', c_void_p, c_void_p),
            ('remarks', c_char_p, c_void_p),
            ('save', c_void_p, c_void_p),
            ('show', c_int, c_void_p, c_void_p, text, error),
            ('count', c_int, c_void_p, c_void_p, text, error),
            ('export', c_int, c_void_p, c_void_p, c_bool, text, error),
            ('expect', c_int, c_void_p, c_void_p, error),
            ('value', c_int, c_void_p, c_void_p, c_void_p, numbers, error),
            ('table', c_int, c_void_p, POINTER(c_void_p), c_int, c_double, POINTER(numbers),
             place, place, POINTER(POINTER(c_char_p)), error),
            ('simulate', c_int, c_void_p, POINTER(_RunOptions), error),
            ('run_figures', c_bool, c_void_p, c_int, POINTER(_Figures)),
            ('columns', c_int, c_void_p, POINTER(c_void_p), c_int, c_double,
             POINTER(POINTER(_Column)), place, place, error),
            ('columns_free', None, POINTER(_Column)),
            ('model_new', c_int, c_void_p, POINTER(_ModelOptions), text, error),
            ('model_free', None, c_void_p),
            ('model_size', c_int, c_void_p, c_int),
            ('model_name', c_char_p, c_void_p, c_int, c_int),
            ('model_unit', c_char_p, c_void_p, c_int, c_int),
            ('model_start', None, c_void_p, numbers, numbers, numbers),
            ('model_function', c_int, c_void_p, c_char_p, place, place),
            ('model_function_name', c_char_p, c_void_p, c_int),
            ('evaluator_new', c_void_p, c_void_p),
            ('evaluator_free', None, c_void_p),
            ('evaluate', None, c_void_p, c_int, *[numbers] * 5),
            ('solve', c_int, c_void_p, *[numbers] * 4),
            ('rates', c_int, c_void_p, *[numbers] * 5),
            ('project', c_int, c_void_p, *[numbers] * 3),
            ('derivatives', c_int, c_void_p, c_int, c_int, *[numbers] * 5),
            ('partial_derivatives', c_int, c_void_p, c_int, c_int, *[numbers] * 5)):
        function = getattr(library, 'ct_' + name)
        function.restype, function.argtypes = result, arguments
    return library


_library = _load()


class Error(Exception):
    """What the library refused: message, hint, and line and column in the text (0: nowhere)."""

    def __init__(self, error):
        self.message, self.hint = error.message.decode(), error.hint.decode()
        self.line, self.column = error.line, error.column
        where = 'line %d, column %d: ' % (self.line, self.column) if self.line > 0 else ''
        super().__init__(where + self.message + (' (%s)' % self.hint if self.hint else ''))


def version():
    return _library.ct_version().decode()


def _checked(function, *arguments):
    error = _Error()
    status = function(*arguments, byref(error))
    if status not in (_OK, _NOT_MINE):
        raise Error(error)
    return status


def _taken(pointer):
    """the text of a new string"""
    if not pointer:
        raise MemoryError
    text = ctypes.string_at(pointer).decode()
    _library.ct_free(pointer)
    return text


def _nested(values, shape):
    if len(shape) < 2:
        return values
    width = len(values) // shape[0] if shape[0] else 0
    return [_nested(values[i * width:(i + 1) * width], shape[1:]) for i in range(shape[0])]


def _flat(values):
    if not hasattr(values, '__iter__'):
        return [values]
    return [number for value in values for number in _flat(value)]


def _array(values, shape):
    """numbers row by row, as an array of numpy or lists of lists"""
    if numpy is None:
        return _nested(list(values), shape)
    return numpy.array(values).reshape(shape)


class _Statements:
    """the statements of a text, one after another; each lives until the next"""

    def __init__(self, text):
        self.text = text.encode()
        self.cursor = _Cursor(self.text, 0, 1, 0)

    def __iter__(self):
        while self.cursor.next < len(self.text):
            statement = c_void_p()
            _checked(_library.ct_parse, byref(self.cursor), False, byref(statement))
            try:
                if not _library.ct_statement_is_empty(statement):
                    yield statement
            finally:
                _library.ct_statement_free(statement)


class Session:
    """A model, its equations and its runs. For one thread at a time."""

    def __init__(self):
        self._handle = _library.ct_session_new(None)
        if not self._handle:
            raise MemoryError

    def __del__(self):
        if getattr(self, '_handle', None):
            _library.ct_session_free(self._handle)

    def _text(self, function, statement, *more):
        out = c_void_p()
        _checked(function, self._handle, statement, *more, byref(out))
        return _taken(out)

    def _carry_out(self, statement):
        verb = _library.ct_verb(statement).decode()
        shown = {'show': _library.ct_show, 'count': _library.ct_count}
        if verb in shown:
            return self._text(shown[verb], statement)
        if verb == 'export':
            return self._text(_library.ct_export, statement, True)
        if verb == 'expect':
            _checked(_library.ct_expect, self._handle, statement)
            return ''
        if _library.ct_carrier(statement) == _SESSION:
            _checked(_library.ct_run, self._handle, statement)
            return _taken(_library.ct_report(self._handle))
        if _checked(_library.ct_apply, self._handle, statement) == _NOT_MINE:
            raise ValueError("'%s' is a statement of the shell" % verb)
        return ''

    def run(self, text):
        """Carry out statements: what builds and runs, show, count, export, expect. Returns what
        they print, with what was remarked."""
        said = []
        for statement in _Statements(text):
            printed = self._carry_out(statement)
            said += [_library.ct_remarks(self._handle).decode(), printed]
        return ''.join(said)

    def value(self, expression):
        """A number, as `print` has it: 'h', 'max(h8)', 'h8 at 2'."""
        value = c_double()
        for statement in _Statements('print ' + expression):
            _checked(_library.ct_value, self._handle, _library.ct_operand(statement, 0),
                     _library.ct_at(statement), byref(value))
        return value.value

    def table(self, items='', every=0):
        """Names of the columns and the rows, of the last run: 'h8 h8'' s11'; '': all."""
        for statement in _Statements('table ' + items):
            names, values = POINTER(c_char_p)(), POINTER(c_double)()
            rows, columns = c_int(), c_int()
            operands = self._operands(statement)
            _checked(_library.ct_table, self._handle, operands, len(operands), every,
                     byref(values), byref(rows), byref(columns), byref(names))
            count = rows.value * columns.value
            out = ([names[i].decode() for i in range(columns.value)],
                   _array(values[:count], (rows.value, columns.value)))
            _library.ct_free(values)
            _library.ct_words_free(names)
            return out

    @staticmethod
    def _operands(statement):
        count = _library.ct_operand_count(statement)
        return (c_void_p * count)(*[_library.ct_operand(statement, i) for i in range(count)])

    def simulate(self, duration, items='', row=None, input=None, resume=False, method=None,
                 check=False, realtime=False, **keys):
        """A forward run; `keys`: every, rtol, atol, step, maxstep. row(t, values) is called at each
        row, with the values of the items in SI, and returns True to stop there; input(name, t,
        values) at the instants of an input, and returns its new value, or None to leave it.
        Returns the report."""
        failed = []

        def guarded(call, values, *arguments):
            try:
                return call(*arguments, list(values[:count]))
            except BaseException as error:  # it can't go through the library
                failed.append(error)
                return None

        def see_row(context, t, values):
            return bool(guarded(row, values, t)) or bool(failed)

        def set_input(context, name, t, values, value):
            number = guarded(input, values, name.decode(), t)
            if number is not None:
                value[0] = number
            return bool(failed)

        for statement in _Statements('table ' + items):
            operands = self._operands(statement)
            count = len(operands)
            options = _RunOptions(
                resume, duration, *[keys.pop(key, 0) for key in
                                    ('every', 'rtol', 'atol', 'step', 'maxstep')],
                method.encode() if method else None, check, realtime,
                ctypes.cast(operands, POINTER(c_void_p)), count, None,
                _SeeRow(see_row if row else 0), _SetInput(set_input if input else 0))
            if keys:
                raise TypeError('simulate() has no %s' % ', '.join(keys))
            error = _Error()
            status = _library.ct_simulate(self._handle, byref(options), byref(error))
        if failed:
            raise failed[0]
        if status not in (_OK, _STOPPED):
            raise Error(error)
        return _taken(_library.ct_report(self._handle))

    def figures(self, run=0):
        """what a run reports as numbers, by name; of the last one, or of run1, run2 ..."""
        figures = _Figures()
        if not _library.ct_run_figures(self._handle, run, byref(figures)):
            raise ValueError('there is no run%d' % run if run else 'there is no run')
        out = {name: getattr(figures, name) for name, _ in _Figures._fields_}
        out['method'] = out['method'].decode() if out['method'] else None
        return out

    def columns(self, items='', every=0):
        """As table(), by names: an array each, and the unit of each ('' where none is known)."""
        for statement in _Statements('table ' + items):
            columns = POINTER(_Column)()
            count, rows = c_int(), c_int()
            operands = self._operands(statement)
            _checked(_library.ct_columns, self._handle, operands, len(operands), every,
                     byref(columns), byref(count), byref(rows))
            names = [column.name.decode() for column in columns[:count.value]]
            values = {name: _array(column.values[:rows.value], (rows.value,))
                      for name, column in zip(names, columns[:count.value])}
            units = {name: column.unit.decode()
                     for name, column in zip(names, columns[:count.value])}
            _library.ct_columns_free(columns)
            return values, units

    def save(self):
        """a script that rebuilds the model"""
        return _taken(_library.ct_save(self._handle))

    def model(self, outputs='', derivatives='', lanes=1):
        """What the model has now, as functions of numbers. `outputs` as for table(), '': those of
        the model; `derivatives`: names of functions that are to be differentiated."""
        handle = c_void_p()
        options = _ModelOptions(None, 0, derivatives.encode() or None, lanes)
        for statement in _Statements('table ' + outputs):
            operands = self._operands(statement)
            options.outputs = ctypes.cast(operands, POINTER(c_void_p))
            options.output_count = len(operands)
            _checked(_library.ct_model_new, self._handle, byref(options), byref(handle))
        return Model(handle.value, lanes)


class Model:
    """A compiled model, which nothing changes; it outlives its session, and threads may share it.

    parameters, states, solution, outputs: names; units: of each name; functions: rows and columns
    of each."""

    def __init__(self, handle, lanes):
        self._handle, self.lanes = handle, lanes
        self.units = {}
        self.parameters, self.states, self.solution, self.outputs = (
            self._names(part) for part in (PARAMETERS, STATE, SOLUTION, OUTPUTS))
        self.functions = {}
        while True:
            name = _library.ct_model_function_name(handle, len(self.functions))
            if name is None:
                break
            rows, columns = c_int(), c_int()
            _library.ct_model_function(handle, name, byref(rows), byref(columns))
            self.functions[name.decode()] = (rows.value, columns.value)

    def __del__(self):
        _library.ct_model_free(self._handle)

    def _names(self, part):
        names = [_library.ct_model_name(self._handle, part, i).decode()
                 for i in range(_library.ct_model_size(self._handle, part))]
        for i, name in enumerate(names):
            self.units[name] = _library.ct_model_unit(self._handle, part, i).decode()
        return names

    def start(self):
        """parameters, the assembled state, and the solution there: p, y, s, of one lane"""
        arrays = [(c_double * len(names))() for names in
                  (self.parameters, self.states, self.solution)]
        _library.ct_model_start(self._handle, *arrays)
        return tuple(_array(array, (len(array),)) for array in arrays)

    def evaluator(self):
        """what computes; each thread has its own"""
        return Evaluator(self)


class Evaluator:
    """The functions of a model in numbers. Arrays are p, t, y and s; with several lanes each entry
    is as many numbers, one a lane. Where there is no solution, there are NANs."""

    def __init__(self, model):
        self.model = model
        self._handle = _library.ct_evaluator_new(model._handle)
        if not self._handle:
            raise MemoryError

    def __del__(self):
        if getattr(self, '_handle', None):
            _library.ct_evaluator_free(self._handle)

    def _numbers(self, values, count):
        """a copy of so many entries, as C has them"""
        lanes = self.model.lanes
        values = (numpy.asarray(values, float).reshape(-1).tolist() if numpy is not None
                  else _flat(values))
        if len(values) == count and lanes > 1:  # the same in all lanes
            values = [value for value in values for _ in range(lanes)]
        if len(values) != count * lanes:
            raise ValueError('%d numbers where %d are wanted' % (len(values), count * lanes))
        return (c_double * (count * lanes))(*values)

    def _inputs(self, p, t, y, s=None):
        model = self.model
        return [self._numbers(p, len(model.parameters)), self._numbers(t, 1),
                self._numbers(y, len(model.states)),
                self._numbers([0] * len(model.solution) if s is None else s,
                              len(model.solution))]

    def _out(self, values, *shape):
        return _array(values, shape + ((self.model.lanes,) if self.model.lanes > 1 else ()))

    def _function(self, name):
        if name not in self.model.functions:
            raise ValueError("the model has no function '%s'" % name)
        return list(self.model.functions).index(name), self.model.functions[name]

    def evaluate(self, name, p, t, y, s=None):
        """what a function gives: 'mass', 'forces', 'outputs', ..."""
        number, shape = self._function(name)
        values = (c_double * (shape[0] * shape[1] * self.model.lanes))()
        _library.ct_evaluate(self._handle, number, *self._inputs(p, t, y, s), values)
        return self._out(values, *shape) if shape[1] != 1 else self._out(values, shape[0])

    def solve(self, p, t, y, s=None):
        """s; what is given is where Newton's method begins"""
        inputs = self._inputs(p, t, y, s)
        _library.ct_solve(self._handle, *inputs)
        return self._out(inputs[3], len(self.model.solution))

    def rates(self, p, t, y, s=None):
        """the rates of y, and s"""
        inputs = self._inputs(p, t, y, s)
        rates = (c_double * len(inputs[2]))()
        _library.ct_rates(self._handle, *inputs, rates)
        return (self._out(rates, len(self.model.states)),
                self._out(inputs[3], len(self.model.solution)))

    def project(self, p, t, y):
        """y on the constraints"""
        inputs = self._inputs(p, t, y)
        _library.ct_project(self._handle, *inputs[:3])
        return self._out(inputs[2], len(self.model.states))

    def derivatives(self, name, by, p, t, y, s, partial=False):
        """Derivatives of a function by PARAMETERS or STATE, with s following from them; `partial`
        those at that s, also by SOLUTION. Entries of the function by entries of the part."""
        number, shape = self._function(name)
        part = (self.model.parameters, self.model.states, self.model.solution)[by]
        count = shape[0] * shape[1]
        values = (c_double * (count * len(part) * self.model.lanes))()
        call = _library.ct_partial_derivatives if partial else _library.ct_derivatives
        status = call(self._handle, number, by, *self._inputs(p, t, y, s), values)
        if status != _OK and not any(value != value for value in values):
            raise ValueError("'%s' was not to be differentiated, or not by that" % name)
        return self._out(values, count, len(part))
