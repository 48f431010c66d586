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
    tf_check_truth(check, 0.25);
    tf_check_variance(check, 1.0 / 9 - 1.0 / 16);
    tf_check_seed(check, 7);
    tf_check_draws(check, 100001);
    tf_check_run(check, draw, NULL);
    puts(tf_check_text(check));
    tf_check_free(check);
    return 0;
}
