#include "firmware/alive.h"
#include "firmware/ground.h"
#include "firmware/pulse_stream.h"
#include "firmware/verbs.h"

static bool answer_word(answer_t *answer, const char *word)
{
    answer_begin(answer);
    telemetry_text(&answer->line, word);
    answer_send(answer);
    return true;
}

bool verb_stream(answer_t *answer)
{
    if (answer_argument_is(answer, "PULSE")) {
        pulse_stream_set(true);
        return answer_word(answer, " PULSE");
    }
    if (answer_argument_is(answer, "OFF")) {
        pulse_stream_set(false);
        return answer_word(answer, " OFF");
    }
    return answer_refuse(answer, "one of PULSE|OFF");
}

/* It ends in a reset. So not with motors that idle either, which would stop. */
bool verb_hang(answer_t *answer)
{
    if (!answer_argument_is(answer, "TASK")) {
        return answer_refuse(answer, "one of TASK");
    }
    if (!ground_idle()) {
        return answer_refuse(answer, "not on the ground");
    }
    /* Before it hangs, or nobody would know that it was obeyed. */
    (void)answer_word(answer, " TASK");
    alive_hang();
    return true;
}
