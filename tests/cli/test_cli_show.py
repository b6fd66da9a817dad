"""``piezo-sym show``: the derived system as text and as LaTeX."""


def test_the_text_has_the_equations_and_the_matrices(call):
    answer = call("show", "piezo_stack")
    assert (answer.code, answer.err) == (0, "")
    lines = [" ".join(line.split()) for line in answer.out.splitlines()]
    assert lines[0] == "piezo_stack: Piezoelectric stack actuator with hysterons"
    assert "dq/dt = p/M" in lines
    assert "y_ambient = T" in lines
    for title in ("J0, structure matrix", "Process hysteron_j", "Process damper", "g, input map"):
        assert title in lines


def test_parameters_have_their_values_in_si(call, spec_file):
    """Also those of laws, which have no value of their own: d*v."""
    text = call("show", spec_file('4e2,    unit = "N*s/m"', '0.4,    unit = "N*s/mm"')).out
    lines = [" ".join(line.split()) for line in text.splitlines()]
    assert "d 400 N*s/m damping" in lines
    assert "T_0 296.15 K reference temperature" in lines


def test_the_driving_force_that_an_input_adds_to_is_shown(call):
    """A voltage across a resistor and a capacitor: the bracket is -Q/C alone."""
    text = call("show", "stack_maxwell").out
    process = text.partition("Process leads\n")[2].partition("\n\n")[0]
    assert "{S,U}_J -Q/C\n" in process
    assert "z       V_in - Q/C," in process
    assert "g, input map; it depends on u" in text
    assert "  z  " not in call("show", "piezo_stack").out


def test_a_storage_shows_its_states_where_they_are_and_how_they_start(call):
    lines = [" ".join(line.split()) for line in call("show", "gas_piston").out.splitlines()]
    place = next(n for n, line in enumerate(lines) if line.startswith("gas storage "))
    assert lines[place].startswith("gas storage q piston - wall energy = N*c_v*T_0*exp(S/(N*c_v))")
    assert lines[place].endswith("q = 0 (not said)")
    assert lines[place + 1].endswith("S = 0 (not said)")


def test_no_body_is_named_twice_and_what_has_no_unit_shows_none(call):
    lines = [" ".join(line.split()) for line in call("show", "peltier_cooler").out.splitlines()]
    assert "couples thermoelectric b - gnd, bodies plate - sink seebeck = s = 0.05 V/K" in lines
    lines = [" ".join(line.split()) for line in call("show", "amplified_stack").out.splitlines()]
    assert "lever lever first tip - wall, second stack - wall ratio = n = 8" in lines
    (energy,) = (line for line in lines if line.startswith("U = "))
    assert " + k_e*max(-g + x_e, 0)**2/2 + " in energy


def test_an_input_that_no_element_uses_is_said_to_be_so(call, spec_file):
    out = call("show", spec_file("[inputs]", '[inputs]\nF_2 = { unit = "N", doc = "pull" }')).out
    (unused,) = (line for line in out.splitlines() if "no element uses" in line)
    assert unused.split() == ["F_2", "N", "0", "pull", "(no", "element", "uses", "it)"]


def test_a_parameter_that_no_law_uses_is_said_to_be_so(call, spec_file):
    """A condition on it does not use it; an initial value does."""
    new = """[parameters]
F_2 = { value = 1.0, unit = "N", doc = "pull" }
q_2 = { value = 1.0, unit = "m" }"""
    path = spec_file("[parameters]", new)
    text = path.read_text(encoding="utf-8").replace('"d >= 0"', '"d >= 0", "F_2 > 0"')
    path.write_text(text.replace("[initial]", '[initial]\nq = "q_2"'), encoding="utf-8")
    answer = call("show", path)
    assert answer.code == 0
    (unused,) = (line for line in answer.out.splitlines() if "no law uses" in line)
    assert unused.split() == ["F_2", "1", "N", "pull", "(no", "law", "uses", "it)"]
    assert "no law uses" not in call("show", "piezo_stack").out


def test_the_domain_says_what_needs_a_condition_that_no_one_wrote(call, spec_file):
    out = call("show", spec_file("deadzone(i, i_0)", "deadzone(i, i_0*(2 - T/T_0))")).out
    domain = out.split("\nDomain\n")[1].split("\n\n")[0].splitlines()
    assert domain[:2] == ["  T > T_0", "  T_e > T_0"]
    assert "  k > 0  (elements.spring)" in domain
    assert domain[-1] == "  i_0*(2 - T/T_0) >= 0  (elements.hysteron.voltage)"


def test_the_latex_is_balanced_mathematics(call):
    answer = call("show", "piezo_stack", "--latex")
    assert (answer.code, answer.err) == (0, "")
    assert r"\alpha_{\mathrm{transducer}}" in answer.out
    assert answer.out.count(r"\[") == answer.out.count(r"\]") > 0
    assert answer.out.count(r"\begin{") == answer.out.count(r"\end{") > 0
    assert answer.out.count("{") == answer.out.count("}")


def test_the_size_of_a_bank_does_not_change_the_mathematics(call, spec_file):
    two, many = (call("show", spec_file("count = 2", f"count = {n}")).out for n in (2, 20_000))
    assert many.replace("20000 in the spec", "2 in the spec") == two


JOINED = """
[model]
name = "joined"
[parameters]
m = { value = 2.0, unit = "kg" }
n = { value = 3.0, unit = "1" }
[domain]
assume = ["n > 0"]
[elements]
m1 = { kind = "mass", at = "a", mass = "m" }
m2 = { kind = "mass", at = "b", mass = "m" }
lever = { kind = "lever", first = ["a", "wall"], second = ["b", "wall"], ratio = "n" }
"""


def test_how_joined_stores_start_is_shown_where_it_is_given(call, tmp_path):
    path = tmp_path / "springs.toml"
    text = """
[model]
name = "springs"
[parameters]
k = { value = 1.0, unit = "N/m" }
m = { value = 1.0, unit = "kg" }
x_0 = { value = 0.5, unit = "m" }
START
[elements]
mass = { kind = "mass", at = "x", mass = "m" }
one = { kind = "spring", between = ["x", "y"], stiffness = "k", state = "q", rest = "x_0" }
two = { kind = "spring", between = ["y", "wall"], stiffness = "2*k", state = "z" }
"""
    path.write_text(text.replace("START", ""))
    out = call("show", path).out
    assert "q (joined, not said)" in out
    assert "z (joined, not said)" in out
    path.write_text(text.replace("START", "[initial]\nq = 0.5\nz = 0.0"))
    out = call("show", path).out
    assert "q = 0.5" in out
    assert "z = 0.0" in out


def test_what_was_joined_is_said(call, tmp_path):
    path = tmp_path / "joined.toml"
    path.write_text(JOINED, encoding="utf-8")
    out = call("show", str(path)).out
    assert "\nJoined: p_m1 = (p_m1 of m1) + (p_m2 of m2)/n\n" in out
    assert "\n  m1: energy m*v_m1**2/2\n" in out
    assert "\n  m2: v_m2 = v_m1/n, energy m*v_m2**2/2\n" in out
