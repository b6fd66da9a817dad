/* The next step of every lane: its purpose, its length, and the prediction of its rates. Comes after outcome.c. */

/* The current step of all lanes: lengths, which lanes they concern, and their outcomes. */
typedef struct {
    real begin, h, behind, slope;
    real ahead, ratio;                 /* where steps begin in those that they recall; how long they are */
    real iterations;                   /* of lanes, before this step */
    int knows_end;                     /* inputs at the end of steps are in end_inputs */
    mask recalling;                    /* steps that recall recorded ones; see predict.c */
    mask busy, sampling, steps, known; /* with any step; a sample's; the run's own; with a prediction */
    mask planned;                      /* steps whose length follows from their errors */
    mask turned;                       /* the known rates are those before a switch */
    mask loose;                        /* Newton's method may stop short of round-off */
    mask resumed;                      /* the step begins at the last sample */
    mask found, good;                  /* the step has rates; it also lies in the domain */
    mask search, switched;             /* a switch has to be located; the step may be cut there */
    mask fits;                         /* the step may end where it does, behind its switch */
    mask booked, turns, ends;          /* the step counts; branches change; steps now end at kinks */
    MODEL(crossing) crossing[REAL_WIDTH];
    double part[REAL_WIDTH];
} MODEL(dispatch);

/*
 * The inputs at the stages of steps; returns whether those at their ends are in end_inputs. Sines at all stages
 * of one run are computed at once, and where lanes are left, in the last of them, that at the end of the step.
 */
static int MODEL(stage_inputs)(MODEL(batch) *b, const MODEL(dispatch) *t)
{
    const MODEL(block) *m = &b->m;
#if defined(LANES)
    int sines = 1;
    for (long k = 0; k < m->inputs; ++k)
        sines &= b->waves[k].others == 0.0;
    for (long i = 0; sines && i < LANES; ++i)
        m->t_lanes[i] = t->begin + (i < STAGES ? stage_at[i] : 1.0) * t->h;
    for (long k = 0; sines && k < m->inputs; ++k) {
        MODEL(sine_at_once)(m, (const double *)(b->waves + k), k);
        for (long i = 0; i < STAGES; ++i)
            m->u[i * m->inputs + k] = *MODEL(place_in)(m->u_lanes, m->inputs, i, k);
        b->end_inputs[k] = *MODEL(place_in)(m->u_lanes, m->inputs, LANES - 1, k); /* else a stage's */
    }
    if (sines)
        return LANES > STAGES;
#endif
    for (long i = 0; i < STAGES; ++i)
        MODEL(inputs_at)(b, t->busy, t->begin + stage_at[i] * t->h, m->u + i * m->inputs);
    return 0;
}

/* Plan the next step of all lanes that have a run. */
static MODEL(dispatch) MODEL(planned)(MODEL(batch) *b)
{
    MODEL(dispatch) t = {.begin = zero, .h = zero, .ahead = zero, .ratio = zero};
    t.behind = t.slope = zero;
    for (int lane = 0; lane < REAL_WIDTH; ++lane) {
        MODEL(lane) *l = b->lane + lane;
        t.crossing[lane].which = -1;
        t.part[lane] = 1.0;
        if (l->phase == IDLE)
            continue;
        MODEL(plan)(b, l);
        SET(t.busy, lane, 1);
        SET(t.sampling, lane, l->phase == SAMPLE || l->phase == RESUME);
        SET(t.resumed, lane, l->phase == RESUME);
        SET(t.planned, lane, l->phase == STEP && b->fixed == 0.0);
        SET(b->m.sketch, lane, IN(t.planned, lane) && !l->settled);
        const int turned = l->phase == STEP && l->behind && l->turned >= 0;
        const int known = l->known > 0.0 && !(turned && l->length > LIKE_BEFORE * l->known);
        SET(t.known, lane, known);
        SET(t.turned, lane, known && turned);
        SET(t.loose, lane, b->fixed == 0.0 && !b->tape && !l->to_round_off); /* a tape needs round-off */
        l->solves += !IN(t.sampling, lane);
        LANE(&t.h, 0, lane) = l->length;
        LANE(&t.begin, 0, lane) = MODEL(begin)(l);
        const double ahead = MODEL(begin)(l) - l->t; /* of the run */
        LANE(&t.behind, 0, lane) = l->behind + (l->known > 0.0 ? ahead / l->known : 0.0);
        l->predicted = l->known > 0.0;
        LANE(&t.slope, 0, lane) = l->known > 0.0 ? l->length / l->known : 0.0;
        if (!IN(t.sampling, lane)) {
            l->recalls = MODEL(recalls)(b, lane, &LANE(&t.ahead, 0, lane), &LANE(&t.ratio, 0, lane));
            SET(t.recalling, lane, l->recalls);
        }
    }
#if defined(COSTATES)
    b->m.loose = t.loose;
    if (b->tape) /* its steps are taken again to the bit */
        b->m.allowed = zero;
#endif /* COSTATES */
    t.knows_end = MODEL(stage_inputs)(b, &t);
    t.steps = t.busy & none_of(t.sampling);
    b->m.sketch &= t.steps & none_of(b->m.over);
    return t;
}

/* Predict the rates of all steps, by the steps before them or by recorded ones. */
static void MODEL(predict_all)(MODEL(batch) *b, const MODEL(dispatch) *t)
{
    mask better = nowhere;
    for (int lane = 0; lane < REAL_WIDTH; ++lane)
        SET(better, lane, IN(t->recalling, lane) && b->lane[lane].repeats);
    /* where recorded steps predict in all lanes, the others are only compared, at the last stage */
    const long first = any(t->busy & none_of(better)) ? 0 : STAGES - 1;
    MODEL(predict)(b, t->behind, t->slope, t->known, t->turned, first);
    if (any(t->recalling))
        MODEL(predict_by_history)(b, t->ahead, t->ratio, t->recalling, better);
}
