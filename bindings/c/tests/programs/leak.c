/* A check that nobody frees: what the leak test must see. */
#include "trueflight.h"

int main(void)
{
    return tf_check_new("lost") == NULL;
}
