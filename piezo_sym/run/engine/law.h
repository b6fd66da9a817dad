/*
 * The functions of a model's laws are compiled apart: an edit of a law leaves what is compiled of all else as it was.
 * Comes after a generated <model>_step.c, on the side that defines these functions, and where LAWS_APART, on that which
 * calls them.
 */
#define OF_STATE const real *restrict x
#define OF_LAWS const MODEL(reals) *restrict p
#define OF_STAGE const real *restrict g, const real *restrict b, const real *restrict u

#if defined(COSTATES)
#define EACH_COSTATE(FUNCTION) \
    FUNCTION(costates, (OF_STATE, const real *restrict g, OF_LAWS, real *restrict out), (x, g, p, out))
#else
#define EACH_COSTATE(FUNCTION)
#endif
#if defined(BENDS)
#define EACH_BEND(FUNCTION) FUNCTION(bends, (OF_STATE, OF_LAWS, real *restrict out), (x, p, out))
#else
#define EACH_BEND(FUNCTION)
#endif
#if defined(PATHS)
#define EACH_PATH(FUNCTION) \
    FUNCTION(path_parameters, (OF_STATE, OF_LAWS, real *restrict out), (x, p, out)) \
    FUNCTION(drives, (OF_STATE, OF_STAGE, OF_LAWS, real *restrict out), (x, g, b, u, p, out))
#else
#define EACH_PATH(FUNCTION)
#endif
#define EACH_FUNCTION(FUNCTION) \
    FUNCTION(integrands, (OF_STATE, OF_LAWS, real *restrict out), (x, p, out)) \
    FUNCTION(stage, (OF_STATE, OF_STAGE, OF_LAWS, real *restrict out, real *restrict rows, real *restrict s, \
                     real *restrict m), (x, g, b, u, p, out, rows, s, m)) \
    FUNCTION(slopes, (OF_STATE, OF_STAGE, OF_LAWS, real *restrict out), (x, g, b, u, p, out)) \
    EACH_COSTATE(FUNCTION) EACH_BEND(FUNCTION) EACH_PATH(FUNCTION)

#define DECLARATION(name, parameters, given) void MODEL(law_##name) parameters;
#if defined(LAWS_APART)
#define DEFINITION(name, parameters, given) \
    static inline void MODEL(name) parameters { MODEL(law_##name) given; }
#else
#define DEFINITION(name, parameters, given) \
    void MODEL(law_##name) parameters { MODEL(name) given; }
#endif

#if defined(__GNUC__) && !defined(_WIN32)
#pragma GCC visibility push(hidden)
#endif
EACH_FUNCTION(DECLARATION)
#if defined(__GNUC__) && !defined(_WIN32)
#pragma GCC visibility pop
#endif
EACH_FUNCTION(DEFINITION)
