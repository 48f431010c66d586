/* A check that is never freed: the leak test must detect it. */
#include "trueflight.h"

int main(void)
{
    return tf_check_new("lost") == NULL;
}
