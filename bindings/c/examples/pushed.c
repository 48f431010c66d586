/* Draws that a program has in an array, with a bias of 2 % that it does not know of: the verdict is fail. */
#include <stdio.h>
#include <stdlib.h>

#include "trueflight.h"

int main(void)
{
    const size_t count = 200000;
    double *pixels = malloc(count * sizeof *pixels);
    if (!pixels) return 2;
    tf_rng rng = {{1, 2, 3, 4}};
    for (size_t i = 0; i < count; ++i) pixels[i] = 1.02 * tf_rng_uniform(&rng);

    tf_check *check = tf_check_new("pixels");
    TF_SET(check, TF_TRUTH, 0.5);
    TF_SET(check, TF_VARIANCE, 1.0 / 12.0);
    TF_SET(check, TF_DRAWS, count);
    /* As they come: by hundreds, or all at once. */
    for (size_t i = 0; i < count; i += 100) tf_check_absorb(check, pixels + i, 100);
    free(pixels);

    tf_verdict verdict;
    tf_numbers found;
    int code = 2;
    if (tf_check_verdict(check, &verdict) == TF_STATUS_OK && tf_check_numbers(check, 0, &found) == TF_STATUS_OK) {
        printf("mean %.4f, %+.1f standard errors off: %s\n", found.mean, found.z, tf_check_reason(check));
        code = verdict == TF_VERDICT_PASS ? 0 : 1;
    } else {
        fprintf(stderr, "%s\n", tf_last_error());
    }
    tf_check_free(check);
    return code;
}
