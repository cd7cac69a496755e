#include "sim/timeline.h"

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "sim/noise.h"
#include "unity.h"

static char trace[256];

void setUp(void)
{
    timeline_reset();
    trace[0] = '\0';
}

void tearDown(void) {}

static void say(void *word)
{
    size_t used = strlen(trace);

    (void)snprintf(trace + used, sizeof trace - used, "%s@%" PRId64 " ", (const char *)word, timeline_now());
}

static void go_to(sim_time_t end)
{
    while (timeline_next() <= end) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

/* ASCII names for say(), which takes a void * */
static char a[] = "a", b[] = "b", c[] = "c", d[] = "d";

void test_events_run_in_order_of_time(void)
{
    (void)timeline_at(30, say, c);
    (void)timeline_at(10, say, a);
    (void)timeline_at(20, say, b);
    go_to(100);
    TEST_ASSERT_EQUAL_STRING("a@10 b@20 c@30 ", trace);
    TEST_ASSERT_EQUAL_INT64(100, timeline_now());
}

void test_events_of_one_time_run_in_order_of_posting(void)
{
    (void)timeline_at(10, say, a);
    (void)timeline_at(10, say, b);
    timeline_id_t gone = timeline_at(10, say, d);
    (void)timeline_at(10, say, c);
    TEST_ASSERT_TRUE(timeline_cancel(gone));
    (void)timeline_at(10, say, d); /* may reuse the memory of the cancelled one, not its turn */
    go_to(10);
    TEST_ASSERT_EQUAL_STRING("a@10 b@10 c@10 d@10 ", trace);
}

void test_after_counts_from_now(void)
{
    go_to(7);
    (void)timeline_after(5, say, a);
    TEST_ASSERT_EQUAL_INT64(12, timeline_next());
}

void test_next_is_never_when_nothing_waits(void)
{
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
    timeline_move_to(5);
    timeline_run_due();
    TEST_ASSERT_EQUAL_INT64(5, timeline_now());
}

static void post_now_and_later(void *word)
{
    say(word);
    (void)timeline_after(0, say, b);
    (void)timeline_after(1, say, c);
}

void test_what_is_posted_for_now_while_running_still_runs_now(void)
{
    (void)timeline_at(10, post_now_and_later, a);
    (void)timeline_at(10, say, d);
    timeline_move_to(10);
    timeline_run_due();
    TEST_ASSERT_EQUAL_STRING("a@10 d@10 b@10 ", trace);
    TEST_ASSERT_EQUAL_INT64(11, timeline_next());
}

void test_a_cancelled_event_does_not_run_and_cannot_be_cancelled_twice(void)
{
    timeline_id_t first = timeline_at(10, say, a);
    timeline_id_t second = timeline_at(20, say, b);

    TEST_ASSERT_NOT_EQUAL_UINT64(0, first);
    TEST_ASSERT_TRUE(timeline_cancel(first));
    TEST_ASSERT_FALSE(timeline_cancel(first));
    TEST_ASSERT_FALSE(timeline_cancel(0));
    go_to(20);
    TEST_ASSERT_EQUAL_STRING("b@20 ", trace);
    TEST_ASSERT_FALSE(timeline_cancel(second));
}

void test_an_id_from_before_a_reset_does_not_cancel_a_new_event(void)
{
    timeline_id_t old = timeline_at(10, say, a);

    timeline_reset();
    TEST_ASSERT_EQUAL_INT64(0, timeline_now());
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
    (void)timeline_at(10, say, b);
    TEST_ASSERT_FALSE(timeline_cancel(old));
    go_to(10);
    TEST_ASSERT_EQUAL_STRING("b@10 ", trace);
}

static void cancel_the_next(void *id)
{
    TEST_ASSERT_TRUE(timeline_cancel(*(timeline_id_t *)id));
}

void test_an_event_can_cancel_another_of_the_same_time(void)
{
    timeline_id_t victim;

    (void)timeline_at(10, cancel_the_next, &victim);
    victim = timeline_at(10, say, a);
    (void)timeline_at(10, say, b);
    go_to(10);
    TEST_ASSERT_EQUAL_STRING("b@10 ", trace);
}

/* ---- against a plain array ---- */

#define MODEL 3000

static struct {
    sim_time_t when;
    timeline_id_t id;
    bool waiting;
} model[MODEL];
static int expected_next;
static int mismatches;

static int first_of_model(void)
{
    int first = -1;

    for (int i = 0; i < MODEL; i++) { /* in order of posting: strictly earlier wins */
        if (model[i].waiting && (first < 0 || model[i].when < model[first].when)) {
            first = i;
        }
    }
    return first;
}

static void run_and_compare(void *entry)
{
    int index = (int)((char *)entry - (char *)model) / (int)sizeof model[0];

    mismatches += index != expected_next || timeline_now() != model[index].when;
    model[index].waiting = false;
}

void test_random_posts_cancels_and_moves_agree_with_a_plain_list(void)
{
    noise_t noise;
    const uint64_t seed = 20240611;

    (void)printf("seed %" PRIu64 "\n", seed);
    noise_init(&noise, seed, "timeline");
    memset(model, 0, sizeof model);
    mismatches = 0;
    for (int posted = 0; posted < MODEL;) {
        uint64_t dice = noise_bits(&noise) % 8;

        if (dice < 4) {
            model[posted].when = timeline_now() + (sim_time_t)(noise_bits(&noise) % 50);
            model[posted].waiting = true;
            model[posted].id = timeline_at(model[posted].when, run_and_compare, &model[posted]);
            posted++;
        } else if (dice < 6 && posted > 0) {
            uint64_t victim = noise_bits(&noise) % (uint64_t)posted;

            mismatches += timeline_cancel(model[victim].id) != model[victim].waiting;
            model[victim].waiting = false;
        } else {
            expected_next = first_of_model();
            sim_time_t when = expected_next < 0 ? SIM_NEVER : model[expected_next].when;

            TEST_ASSERT_EQUAL_INT64(when, timeline_next());
            if (expected_next >= 0) {
                timeline_move_to(when);
                /* one at a time: the others of this instant are expected in turn */
                while (expected_next >= 0 && model[expected_next].when == when) {
                    int same_time = 0;

                    for (int i = 0; i < posted; i++) {
                        same_time += model[i].waiting && model[i].when == when;
                    }
                    if (same_time > 1) {
                        TEST_ASSERT_TRUE(timeline_cancel(model[expected_next].id));
                        model[expected_next].waiting = false;
                    } else {
                        timeline_run_due();
                    }
                    expected_next = first_of_model();
                }
            }
        }
    }
    TEST_ASSERT_EQUAL_INT(0, mismatches);
}

static int64_t last_when;
static int ran;

static void check_order(void *unused)
{
    (void)unused;
    mismatches += timeline_now() < last_when;
    last_when = timeline_now();
    ran++;
}

void test_a_hundred_thousand_waiting_events_come_out_sorted(void)
{
    noise_t noise;

    noise_init(&noise, 7, "many");
    mismatches = 0;
    last_when = 0;
    ran = 0;
    for (int i = 0; i < 100000; i++) {
        (void)timeline_at((sim_time_t)(noise_bits(&noise) % 1000000), check_order, NULL);
    }
    go_to(1000000);
    TEST_ASSERT_EQUAL_INT(100000, ran);
    TEST_ASSERT_EQUAL_INT(0, mismatches);
}

/* ---- errors of the caller ---- */

static bool aborts(void (*offence)(void))
{
    int status = 0;

    (void)fflush(NULL);
    pid_t child = fork();

    if (child == 0) {
        (void)fclose(stderr);
        (void)signal(SIGABRT, SIG_DFL);
        offence();
        _exit(0);
    }
    TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT;
}

static void post_into_the_past(void)
{
    timeline_move_to(10);
    (void)timeline_at(9, say, a);
}

static void post_for_now(void)
{
    timeline_move_to(10);
    (void)timeline_at(10, say, a);
}

static void move_back(void)
{
    timeline_move_to(10);
    timeline_move_to(9);
}

static void move_over_an_event(void)
{
    (void)timeline_at(10, say, a);
    timeline_move_to(11);
}

static void move_onto_an_event(void)
{
    (void)timeline_at(10, say, a);
    timeline_move_to(10);
}

void test_posting_into_the_past_aborts(void)
{
    TEST_ASSERT_TRUE(aborts(post_into_the_past));
    TEST_ASSERT_FALSE(aborts(post_for_now));
}

void test_moving_back_or_over_a_waiting_event_aborts(void)
{
    TEST_ASSERT_TRUE(aborts(move_back));
    TEST_ASSERT_TRUE(aborts(move_over_an_event));
    TEST_ASSERT_FALSE(aborts(move_onto_an_event));
}
