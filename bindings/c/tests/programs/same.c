/* The draws of a callback are those of a Rust closure with the same name and seed. */
#include <stdio.h>

#include "trueflight.h"

static double draw(tf_rng *rng, void *user)
{
    (void)user;
    return tf_rng_uniform(rng) * tf_rng_positive_uniform(rng);
}

int main(void)
{
    tf_check *check = tf_check_new("the same draws");
    TF_SET(check, TF_TRUTH, 0.25);
    TF_SET(check, TF_VARIANCE, 1.0 / 9 - 1.0 / 16);
    tf_check_seed(check, 7);
    TF_SET(check, TF_DRAWS, 100001);
    tf_check_run(check, draw, NULL);
    puts(tf_check_text(check));
    tf_check_free(check);
    return 0;
}
