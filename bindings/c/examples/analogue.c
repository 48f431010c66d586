/* The transmittance of a homogeneous medium of depth 1: does a photon fly farther than 1? */
#include <math.h>
#include <stdio.h>

#include "trueflight.h"

static double draw(tf_rng *rng, void *depth)
{
    return -log(tf_rng_positive_uniform(rng)) > *(const double *)depth ? 1.0 : 0.0;
}

int main(void)
{
    double depth = 1.0;
    tf_check *check = tf_check_new("analogue");
    TF_SET(check, TF_TRUTH, exp(-depth));
    TF_SET(check, TF_RANGE, 0.0, 1.0);
    tf_check_run(check, draw, &depth);

    const int passed = tf_check_passed(check);
    puts(tf_check_text(check));
    tf_check_free(check);
    return passed ? 0 : 1;
}
