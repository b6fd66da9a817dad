"""Names that a person gives and that a program may take for its own.

All of them are allowed by the rules for names; what another name of the spec forbids (the lane of a
bank, the size of a bank) is found when the spec is read, and others are drawn.
"""

#: For parameters, inputs and states.
_SYMBOLS = """
a b k d c L M R C rho a_1 a_j b_j b_1 k_j h h_j h_1 phi_h phi_j phi_1 p_m p_mass q t m x u
z y w n r s e E I N O Q S pi oo nan inf zoo gamma beta zeta ite let sqrt_1 root_argument_1 root_1
quotient_1 log_1 exp_1 v_mass v_m v_1 v_j i_1 i_j i_0 f_1 T_0 T_1 T_e S_1 S_j F_1 F_d F_j V_1 V_j
j J x_j u_j declare push pop check unsat select store forall exists Real div mod distinct xor
real mask double_1 lane lanes tau sigma energy_1 skip_1 d_1 d_2 d_j sum_1 Sum fmin pow fabs y0 j1
lam lam_1 bank own_1 value here p q L_h M_m G U H D0 z3 Abs Max Min Pow diff subs state"""
#: For elements: keywords are allowed there.
_ELEMENTS = """
h h_j h_1 hj h_jj j i v f T m mass body_1 d d_j d_1 d_2 damper spring k if and let ite
x u p q phi S h_inner inner gnd wall tip v_mass i_h V_h F_d lane sum abs_1 sqrt rate energy_1
in not or assert c_j r_j r R L Q s_1 s_j bank bank_j bank_1 n0 n1 n2 n3 n4 n5 n6 n7 n8 n9"""
_NODES = "tip x m n in out p h h_j 1 2 a.b a_b v+ v- T q"
SYMBOLS, ELEMENTS, NODES = _SYMBOLS.split(), _ELEMENTS.split(), _NODES.split()
