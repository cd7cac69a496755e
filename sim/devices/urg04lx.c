#include "sim/devices/urg04lx.h"

#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LAST_STEP 768
#define STEPS_N (LAST_STEP + 1)
#define AMIN_STEP 44
#define AMAX_STEP 725
#define INSTANT_STEP 389     /* that config.ray_instant tells */
#define STEPS_IN_A_TURN 1024 /* of which a reply may ask for 769 */
#define NEAREST_GOOD_MM 20
#define CODE_NOT_MEASURABLE 19
#define CODE_BEYOND_SCIP1 16
#define BLOCK_N 64
#define TIME_MASK 0xFFFFFFL
#define BIT_TOLERANCE 0.045
#define COMMAND_N 80
#define QUEUE_N 8
#define STRING_N 16
#define TROUBLE_ENDS 50 /* first code that ends a measurement */
#define TROUBLE_OVER 98
#define VERIFY_TURNS 10
/* From `V` to its echo, the latest of three recorded first answers (logs of hokuyo_aist; the others took 64
 * and 10 ms). docs/scip.md, "A late first answer". */
#define FIRST_ANSWER (381 * SIM_MS)

typedef struct {
    char text[COMMAND_N + 1];
    size_t length; /* characters received; text keeps the first COMMAND_N */
    bool foreign;  /* holds an octet that no command may have */
    bool repeated; /* same symbol as the one before, which is still unanswered */
} command_t;

/* A measurement asked for: sampled step by step in one revolution, sent at its end. */
typedef struct {
    urg04lx_t *urg;
    timeline_action_t turn_over;
    command_t command;
    int first, last, cluster, width; /* last: of the last point */
    int beyond;                      /* what stands for a distance that the field cannot hold */
    bool active;
    int64_t turn;
    int next; /* step to be sampled */
    timeline_id_t event;
    int distance_mm[STEPS_N];
} scan_t;

struct urg04lx {
    urg04lx_config_t config;
    urg_world_t world;
    void *world_context;
    serial_sink_t sink;
    void *sink_context;

    serial_t line;
    double next_rate; /* takes over when the line falls silent; 0: none */
    timeline_id_t boot_event;
    bool powered, ready, scip2, laser_on, time_mode;
    bool answered; /* any command since power-up */
    sim_time_t first_turn, clock_zero;

    command_t incoming;
    command_t queue[QUEUE_N];
    size_t queue_head, queue_count;
    char latest_symbol[2];
    timeline_id_t command_event;

    scan_t single, stream;
    bool endless;
    int remaining, interval;
    unsigned trouble; /* to be reported; 0: none */
    bool verifying;   /* 98 is next */

    unsigned scans_sent, revolutions_skipped, octets_mismatched, commands, refused;
};

typedef struct {
    char symbol[3];
    size_t parameters;
    void (*handle)(urg04lx_t *urg, const command_t *command);
} verb_t;

const urg04lx_config_t urg04lx_default = {
    .power_up_rate = 115200.0,
    .boot = 8 * SIM_S,
    .latency = 8 * SIM_MS,
    .revolution = 100 * SIM_MS,
    .phase = 0,
    .ray_instant = 34 * SIM_MS,
    .clock_ratio = 1.0,
};

/* ---- what goes out ---- */

static void put(urg04lx_t *urg, const char *text, size_t length)
{
    serial_send(&urg->line, text, length);
}

static void put_text(urg04lx_t *urg, const char *text)
{
    put(urg, text, strlen(text));
}

static char sum_of(const char *text, size_t length)
{
    unsigned total = 0;

    for (size_t i = 0; i < length; i++) {
        total += (unsigned char)text[i];
    }
    return (char)((total & 0x3F) + 0x30);
}

static void put_summed(urg04lx_t *urg, const char *text, size_t length)
{
    const char tail[] = {sum_of(text, length), '\n'};

    put(urg, text, length);
    put(urg, tail, sizeof tail);
}

static void put_field(urg04lx_t *urg, const char *text)
{
    const char tail[] = {';', sum_of(text, strlen(text)), '\n'};

    put_text(urg, text);
    put(urg, tail, sizeof tail);
}

static void put_echo(urg04lx_t *urg, const command_t *command)
{
    put(urg, command->text, command->length < COMMAND_N ? command->length : COMMAND_N);
    put_text(urg, "\n");
}

/* Echo and status; what follows ends with one more LF. */
static void put_head(urg04lx_t *urg, const command_t *command, const char *status)
{
    put_echo(urg, command);
    put_summed(urg, status, 2);
    urg->commands++;
    urg->refused += strcmp(status, "00") != 0;
}

static void answer(urg04lx_t *urg, const command_t *command, const char *status)
{
    put_head(urg, command, status);
    put_text(urg, "\n");
}

static size_t encode(long value, int width, char *text)
{
    for (int i = width - 1; i >= 0; i--) {
        text[i] = (char)((value & 0x3F) + 0x30);
        value >>= 6;
    }
    return (size_t)width;
}

static long clock_ms(const urg04lx_t *urg, sim_time_t when)
{
    double elapsed_ms = (double)(when - urg->clock_zero) * urg->config.clock_ratio / 1e6;

    return (long)floor(elapsed_ms) & TIME_MASK;
}

static void put_time(urg04lx_t *urg, sim_time_t when)
{
    char text[4];

    put_summed(urg, text, encode(clock_ms(urg, when), 4, text));
}

/* ---- revolutions and scans ---- */

static sim_time_t turn_start(const urg04lx_t *urg, int64_t turn)
{
    return urg->first_turn + turn * urg->config.revolution;
}

/* The first revolution that starts after now. */
static int64_t next_turn(const urg04lx_t *urg)
{
    sim_time_t turning = timeline_now() - urg->first_turn;

    return turning < 0 ? 0 : turning / urg->config.revolution + 1;
}

static int last_at_once(const scan_t *scan, int from)
{
    const int last = from + URG_RAYS_AT_ONCE - 1;

    return last < scan->last ? last : scan->last;
}

/* The mirror looks at the middle of the steps that are sampled together, from this one on. */
static sim_time_t nominal(const scan_t *scan, int from)
{
    const urg04lx_t *urg = scan->urg;
    const double middle = 0.5 * (from + last_at_once(scan, from)) - INSTANT_STEP;

    return turn_start(urg, scan->turn) + urg->config.ray_instant +
           (sim_time_t)llround(middle / STEPS_IN_A_TURN * (double)urg->config.revolution);
}

/* Where the revolution has no room for the ray_instant that was set, all its rays come later, or all earlier:
 * the mirror turns evenly. */
static sim_time_t instant(const scan_t *scan)
{
    const urg04lx_t *urg = scan->urg;
    const sim_time_t too_early = turn_start(urg, scan->turn) - nominal(scan, scan->first);
    const sim_time_t too_late = nominal(scan, scan->last) - turn_start(urg, scan->turn + 1);

    return nominal(scan, scan->next) + (too_early > 0 ? too_early : 0) - (too_late > 0 ? too_late : 0);
}

static void sample(void *context)
{
    scan_t *scan = context;
    const urg04lx_t *urg = scan->urg;
    const urg_rays_t rays = {.first_step = scan->first,
                             .last_step = scan->last,
                             .from_step = scan->next,
                             .to_step = last_at_once(scan, scan->next)};

    urg->world(urg->world_context, &rays, scan->distance_mm + rays.from_step);
    scan->next = rays.to_step + 1;
    scan->event = scan->next <= scan->last
                      ? timeline_at(instant(scan), sample, scan)
                      : timeline_at(turn_start(urg, scan->turn + 1), scan->turn_over, scan);
}

static void await_turn(scan_t *scan, int64_t turn)
{
    scan->active = true;
    scan->turn = turn;
    scan->next = scan->first;
    scan->event = timeline_at(instant(scan), sample, scan);
}

static void drop_scan(scan_t *scan)
{
    if (scan->active) {
        timeline_cancel(scan->event);
        scan->active = false;
    }
}

static int step_mm(const scan_t *scan, int step)
{
    return step < AMIN_STEP || step > AMAX_STEP ? CODE_NOT_MEASURABLE : scan->distance_mm[step];
}

/* The smallest good distance of a cluster, or its first step's code when none is good. */
static int cluster_mm(const scan_t *scan, int from)
{
    int nearest = step_mm(scan, from);

    for (int step = from + 1; step < from + scan->cluster && step <= scan->last; step++) {
        int mm = step_mm(scan, step);
        if (mm >= NEAREST_GOOD_MM && (nearest < NEAREST_GOOD_MM || mm < nearest)) {
            nearest = mm;
        }
    }
    return nearest;
}

static size_t encode_scan(const scan_t *scan, char *text)
{
    int largest = (1 << (6 * scan->width)) - 1;
    size_t length = 0;

    for (int from = scan->first; from <= scan->last; from += scan->cluster) {
        int mm = cluster_mm(scan, from);
        length += encode(mm > largest ? scan->beyond : mm, scan->width, text + length);
    }
    return length;
}

static void put_blocks(scan_t *scan, bool summed)
{
    char text[3 * STEPS_N];
    size_t length = encode_scan(scan, text);

    for (size_t at = 0; at < length; at += BLOCK_N) {
        size_t block = length - at < BLOCK_N ? length - at : BLOCK_N;
        if (summed) {
            put_summed(scan->urg, text + at, block);
        } else {
            put(scan->urg, text + at, block);
            put_text(scan->urg, "\n");
        }
    }
    put_text(scan->urg, "\n");
    scan->urg->scans_sent++;
}

static bool number(const char *digits, size_t count, int *value)
{
    *value = 0;
    for (size_t i = 0; i < count; i++) {
        if (digits[i] < '0' || digits[i] > '9') {
            return false;
        }
        *value = 10 * *value + (digits[i] - '0');
    }
    return true;
}

/* ---- queue of commands ---- */

static void handle_next(void *context);

static bool unanswered(const urg04lx_t *urg)
{
    return urg->queue_count > 0 || urg->single.active;
}

static bool at_once(const char *text)
{
    return strncmp(text, "TM", 2) == 0 || strncmp(text, "GD", 2) == 0 || strncmp(text, "GS", 2) == 0;
}

static sim_time_t answer_delay(const urg04lx_t *urg)
{
    if (!urg->config.answers_in_turn) {
        return urg->config.latency;
    }
    if (!urg->answered) {
        return FIRST_ANSWER;
    }
    return urg->scip2 && !at_once(urg->queue[urg->queue_head].text)
               ? turn_start(urg, next_turn(urg)) - timeline_now()
               : urg->config.latency;
}

static void pump(urg04lx_t *urg)
{
    bool blocked = urg->single.active || urg->next_rate > 0.0;

    if (urg->command_event == 0 && urg->queue_count > 0 && !blocked) {
        urg->command_event = timeline_after(answer_delay(urg), handle_next, urg);
    }
}

static void stop_measuring(urg04lx_t *urg)
{
    drop_scan(&urg->stream);
    urg->verifying = false;
    urg->laser_on = false;
}

static void request_scan(scan_t *scan, const command_t *command)
{
    scan->command = *command;
    if (scan->cluster == 0) {
        scan->cluster = 1;
    }
    if (scan->urg->config.rounds_down) {
        scan->last -= (scan->last - scan->first + 1) % scan->cluster;
    }
    await_turn(scan, next_turn(scan->urg));
}

/* ---- SCIP2.0 ---- */

typedef struct {
    char characters[3];
} status_t;

static status_t trouble_text(unsigned code)
{
    return (status_t){{(char)('0' + code / 10), (char)('0' + code % 10), '\0'}};
}

static void refuse_single(const scan_t *scan)
{
    urg04lx_t *urg = scan->urg;

    answer(urg, &scan->command, trouble_text(urg->trouble).characters);
    urg->trouble = 0;
    urg->laser_on = false;
}

static void scip2_single_over(void *context)
{
    scan_t *scan = context;
    urg04lx_t *urg = scan->urg;

    scan->active = false;
    if (urg->trouble >= TROUBLE_ENDS && urg->trouble != TROUBLE_OVER) {
        refuse_single(scan);
    } else {
        put_head(urg, &scan->command, "00");
        put_time(urg, turn_start(urg, scan->turn));
        put_blocks(scan, true);
    }
    pump(urg);
}

static void put_stream_head(scan_t *scan, const char *status)
{
    urg04lx_t *urg = scan->urg;

    scan->command.text[13] = (char)('0' + urg->remaining / 10);
    scan->command.text[14] = (char)('0' + urg->remaining % 10);
    put_echo(urg, &scan->command);
    put_summed(urg, status, 2);
}

static void put_stream_frame(scan_t *scan)
{
    serial_hold(&scan->urg->line, timeline_now() + scan->urg->config.late);
    put_stream_head(scan, "99");
    put_time(scan->urg, turn_start(scan->urg, scan->turn));
    put_blocks(scan, true);
}

/* In place of a stream's frame. */
static void report_trouble(scan_t *scan)
{
    urg04lx_t *urg = scan->urg;
    unsigned code = urg->trouble != 0 ? urg->trouble : TROUBLE_OVER;

    put_stream_head(scan, trouble_text(code).characters);
    put_text(urg, "\n");
    urg->trouble = 0;
    urg->verifying = code < TROUBLE_ENDS;
    if (code == TROUBLE_OVER) {
        await_turn(scan, scan->turn + 1 + urg->interval);
    } else if (urg->verifying) {
        await_turn(scan, scan->turn + VERIFY_TURNS);
    } else {
        scan->active = false;
        urg->laser_on = false;
    }
}

static void stream_turn_over(void *context)
{
    scan_t *scan = context;
    urg04lx_t *urg = scan->urg;

    if (!serial_idle(&urg->line)) {
        urg->revolutions_skipped++;
        await_turn(scan, scan->turn + 1);
        return;
    }
    if (urg->trouble != 0 || urg->verifying) {
        report_trouble(scan);
        return;
    }
    if (!urg->endless) {
        urg->remaining--;
    }
    put_stream_frame(scan);
    if (urg->endless || urg->remaining > 0) {
        await_turn(scan, scan->turn + 1 + urg->interval);
    } else {
        scan->active = false;
        urg->laser_on = false;
    }
}

typedef struct {
    int first, last, cluster, interval, count;
} range_t;

/* NULL when every character of the parameters is a digit where one must be. */
static const char *parse_range(const char *text, bool stream, range_t *range)
{
    if (!number(text + 2, 4, &range->first)) {
        return "01";
    }
    if (!number(text + 6, 4, &range->last)) {
        return "02";
    }
    if (!number(text + 10, 2, &range->cluster)) {
        return "03";
    }
    if (stream && !number(text + 12, 1, &range->interval)) {
        return "06";
    }
    if (stream && !number(text + 13, 2, &range->count)) {
        return "07";
    }
    return NULL;
}

static const char *check_range(const char *text, bool stream, range_t *range)
{
    const char *fault = parse_range(text, stream, range);

    if (fault != NULL) {
        return fault;
    }
    if (range->last > LAST_STEP) {
        return "04";
    }
    return range->last < range->first ? "05" : "00";
}

static void set_range(scan_t *scan, const range_t *range, int width)
{
    scan->first = range->first;
    scan->last = range->last;
    scan->cluster = range->cluster;
    scan->width = width;
    scan->beyond = (1 << (6 * width)) - 1;
}

static int width_of(const command_t *command)
{
    return command->text[1] == 'D' ? 3 : 2;
}

static void handle_single(urg04lx_t *urg, const command_t *command)
{
    range_t range;
    const char *status = check_range(command->text, false, &range);

    if (strcmp(status, "00") == 0 && !urg->laser_on) {
        status = "10";
    }
    if (strcmp(status, "00") != 0) {
        answer(urg, command, status);
        return;
    }
    set_range(&urg->single, &range, width_of(command));
    urg->single.turn_over = scip2_single_over;
    request_scan(&urg->single, command);
}

static void handle_stream(urg04lx_t *urg, const command_t *command)
{
    range_t range;
    const char *status = check_range(command->text, true, &range);

    answer(urg, command, status);
    if (strcmp(status, "00") != 0) {
        return;
    }
    drop_scan(&urg->stream);
    urg->verifying = false;
    set_range(&urg->stream, &range, width_of(command));
    urg->endless = range.count == 0;
    urg->remaining = range.count;
    urg->interval = range.interval;
    urg->laser_on = true;
    urg->stream.turn_over = stream_turn_over;
    request_scan(&urg->stream, command);
}

static void handle_bm(urg04lx_t *urg, const command_t *command)
{
    answer(urg, command, urg->laser_on ? "02" : "00");
    urg->laser_on = true;
}

static void handle_qt(urg04lx_t *urg, const command_t *command)
{
    stop_measuring(urg);
    answer(urg, command, "00");
}

static void handle_rs(urg04lx_t *urg, const command_t *command)
{
    stop_measuring(urg);
    urg->clock_zero = timeline_now();
    urg->next_rate = urg->config.power_up_rate;
    answer(urg, command, "00");
}

static void tell_time(urg04lx_t *urg, const command_t *command)
{
    put_head(urg, command, "00");
    put_time(urg, timeline_now());
    put_text(urg, "\n");
}

static void handle_tm(urg04lx_t *urg, const command_t *command)
{
    switch (command->text[2]) {
    case '0':
        answer(urg, command, urg->time_mode ? "02" : "00");
        stop_measuring(urg);
        urg->time_mode = true;
        break;
    case '1':
        if (urg->time_mode) {
            tell_time(urg, command);
        } else {
            answer(urg, command, "04");
        }
        break;
    case '2':
        answer(urg, command, urg->time_mode ? "00" : "03");
        urg->time_mode = false;
        break;
    default:
        answer(urg, command, "01");
    }
}

static const char *check_rate(const urg04lx_t *urg, const char *digits, int *rate)
{
    static const int known[] = {19200, 57600, 115200, 250000, 500000, 750000};

    if (!number(digits, 6, rate)) {
        return "01";
    }
    if (*rate == 38400) {
        return "04";
    }
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (*rate == known[i]) {
            return fabs(urg->line.rate - *rate) < 0.5 ? "03" : "00";
        }
    }
    return "02";
}

static void handle_ss(urg04lx_t *urg, const command_t *command)
{
    int rate;
    const char *status = check_rate(urg, command->text + 2, &rate);

    if (strcmp(status, "00") == 0) {
        urg->next_rate = rate;
    }
    answer(urg, command, status);
}

static void handle_cr(urg04lx_t *urg, const command_t *command)
{
    int speed;

    if (!number(command->text + 2, 2, &speed)) {
        answer(urg, command, "01");
    } else if (speed == 99) {
        answer(urg, command, "00");
    } else if (speed > 10) {
        answer(urg, command, "02");
    } else {
        answer(urg, command, speed == 0 ? "03" : "04");
    }
}

static void handle_hs(urg04lx_t *urg, const command_t *command)
{
    answer(urg, command, "0C");
}

static void handle_vv(urg04lx_t *urg, const command_t *command)
{
    put_head(urg, command, "00");
    put_field(urg, "VEND:Hokuyo Automatic Co.,Ltd.");
    put_field(urg, "PROD:SOKUIKI Sensor URG-04LX");
    put_field(urg, "FIRM:3.1.04(02/Aug./2007)");
    put_field(urg, "PROT:SCIP 2.0");
    put_field(urg, "SERI:H0706400");
    put_text(urg, "\n");
}

static void handle_pp(urg04lx_t *urg, const command_t *command)
{
    put_head(urg, command, "00");
    put_field(urg, "MODL:URG-04LX(Hokuyo Automatic Co.,Ltd.)");
    put_field(urg, "DMIN:20");
    put_field(urg, "DMAX:5600");
    put_field(urg, "ARES:1024");
    put_field(urg, "AMIN:44");
    put_field(urg, "AMAX:725");
    put_field(urg, "AFRT:384");
    put_field(urg, "SCAN:600");
    put_text(urg, "\n");
}

static void handle_ii(urg04lx_t *urg, const command_t *command)
{
    char text[64];

    put_head(urg, command, "00");
    put_field(urg, "MODL:URG-04LX(Hokuyo Automatic Co.,Ltd.)");
    put_field(urg, urg->laser_on ? "LASR:ON" : "LASR:OFF");
    put_field(urg, "SCSP:Initial(600[rpm])<-Default setting by user");
    put_field(urg, urg->laser_on ? "MESM:CLASSIC" : "MESM:IDLE");
    snprintf(text, sizeof text, "SBPS:%.0f[bps]<-Default setting by user", urg->line.rate);
    put_field(urg, text);
    snprintf(text, sizeof text, "TIME:%06lX", (unsigned long)clock_ms(urg, timeline_now()));
    put_field(urg, text);
    put_field(urg, "STAT:Sensor works well.");
    put_text(urg, "\n");
}

static const verb_t verbs[] = {
    {"BM", 0, handle_bm},      {"QT", 0, handle_qt},      {"RS", 0, handle_rs},
    {"TM", 1, handle_tm},      {"SS", 6, handle_ss},      {"CR", 2, handle_cr},
    {"HS", 1, handle_hs},      {"VV", 0, handle_vv},      {"PP", 0, handle_pp},
    {"II", 0, handle_ii},      {"MD", 13, handle_stream}, {"MS", 13, handle_stream},
    {"GD", 10, handle_single}, {"GS", 10, handle_single},
};

static const verb_t *find_verb(const command_t *command)
{
    for (size_t i = 0; i < sizeof verbs / sizeof verbs[0]; i++) {
        if (strncmp(command->text, verbs[i].symbol, 2) == 0) {
            return &verbs[i];
        }
    }
    return NULL;
}

static bool string_letters(const char *text)
{
    for (; *text != '\0'; text++) {
        if (!isalnum((unsigned char)*text) && strchr(" ._+@", *text) == NULL) {
            return false;
        }
    }
    return true;
}

static const char *check_string(const char *text)
{
    if (*text == '\0') {
        return "0C";
    }
    if (strlen(text) > STRING_N) {
        return "0G";
    }
    return string_letters(text) ? NULL : "0H";
}

/* NULL when the command may be handled. */
static const char *check_command(const urg04lx_t *urg, const command_t *command, const verb_t *verb)
{
    size_t own = strcspn(command->text, ";");
    const char *fault = NULL;

    if (command->foreign) {
        return "0H";
    }
    if (own < 2) {
        return "0D";
    }
    if (verb == NULL) {
        return "0E";
    }
    if (own != 2 + verb->parameters) {
        return own < 2 + verb->parameters ? "0C" : "0D";
    }
    if (command->text[own] == ';') {
        fault = check_string(command->text + own + 1);
    }
    if (fault == NULL && command->repeated) {
        fault = "0B";
    }
    if (fault == NULL && urg->time_mode && verb->handle != handle_tm) {
        fault = "0E";
    }
    return fault;
}

static void scip2_handle(urg04lx_t *urg, const command_t *command)
{
    const verb_t *verb = find_verb(command);
    const char *fault = check_command(urg, command, verb);

    if (fault != NULL) {
        answer(urg, command, fault);
    } else {
        verb->handle(urg, command);
    }
}

/* ---- SCIP1.1 ---- */

static void scip1_head(urg04lx_t *urg, const command_t *command, char status)
{
    const char line[] = {status, '\n'};

    put_echo(urg, command);
    put(urg, line, sizeof line);
    urg->commands++;
    urg->refused += status != '0';
}

static void scip1_answer(urg04lx_t *urg, const command_t *command, char status)
{
    scip1_head(urg, command, status);
    put_text(urg, "\n");
}

static void scip1_switch(urg04lx_t *urg, const command_t *command)
{
    scip1_answer(urg, command, '0');
    urg->scip2 = true;
    urg->laser_on = false;
}

static void scip1_laser(urg04lx_t *urg, const command_t *command)
{
    bool on = command->text[1] == '1';

    scip1_answer(urg, command, on && urg->laser_on ? '2' : '0');
    urg->laser_on = on;
}

static void scip1_version(urg04lx_t *urg, const command_t *command)
{
    scip1_head(urg, command, '0');
    put_text(urg, "VEND:Hokuyo Automatic Co.,Ltd.\n"
                  "PROD:SOKUIKI Sensor URG-04LX\n"
                  "FIRM:3.1.04,07/08/02(20-4095[mm],240[deg],44-725[step],600[rpm])\n"
                  "PROT:00003,(SCIP 1.0)\n"
                  "SERI:H0706400\n"
                  "STAT:FW Normal[FinalDist with shadow  ]\n\n");
}

static void scip1_rate(urg04lx_t *urg, const command_t *command)
{
    int rate;
    const char *status = check_rate(urg, command->text + 1, &rate);
    bool same = strcmp(status, "03") == 0, accepted = strcmp(status, "00") == 0;

    if (accepted) {
        urg->next_rate = rate;
    }
    scip1_answer(urg, command, accepted || same ? '0' : 'E');
}

static void scip1_single_over(void *context)
{
    scan_t *scan = context;

    scan->active = false;
    scip1_head(scan->urg, &scan->command, '0');
    put_blocks(scan, false);
    pump(scan->urg);
}

static void scip1_scan(urg04lx_t *urg, const command_t *command)
{
    range_t range;
    bool good = number(command->text + 1, 3, &range.first) && number(command->text + 4, 3, &range.last) &&
                number(command->text + 7, 2, &range.cluster) && range.last <= LAST_STEP &&
                range.first <= range.last;

    if (!good || !urg->laser_on) {
        scip1_answer(urg, command, good ? '6' : 'E');
        return;
    }
    set_range(&urg->single, &range, 2);
    urg->single.beyond = CODE_BEYOND_SCIP1;
    urg->single.turn_over = scip1_single_over;
    request_scan(&urg->single, command);
}

static void scip1_handle(urg04lx_t *urg, const command_t *command)
{
    const char *text = command->text;

    if (command->foreign) {
        scip1_answer(urg, command, 'E');
    } else if (strcmp(text, "SCIP2.0") == 0) {
        scip1_switch(urg, command);
    } else if (strcmp(text, "L0") == 0 || strcmp(text, "L1") == 0) {
        scip1_laser(urg, command);
    } else if (strcmp(text, "V") == 0) {
        scip1_version(urg, command);
    } else if (text[0] == 'S' && command->length == 14) {
        scip1_rate(urg, command);
    } else if (text[0] == 'G' && command->length == 9) {
        scip1_scan(urg, command);
    } else {
        scip1_answer(urg, command, 'E');
    }
}

/* ---- what comes in ---- */

static void handle_next(void *context)
{
    urg04lx_t *urg = context;
    command_t command = urg->queue[urg->queue_head];

    urg->command_event = 0;
    urg->answered = true;
    urg->queue_head = (urg->queue_head + 1) % QUEUE_N;
    urg->queue_count--;
    if (urg->scip2) {
        scip2_handle(urg, &command);
    } else {
        scip1_handle(urg, &command);
    }
    pump(urg);
}

static void command_complete(urg04lx_t *urg)
{
    command_t *command = &urg->incoming;

    if (command->length > 0 && urg->queue_count < QUEUE_N) {
        command->repeated = urg->scip2 && unanswered(urg) &&
                            memcmp(command->text, urg->latest_symbol, 2) == 0;
        memcpy(urg->latest_symbol, command->text, 2);
        urg->queue[(urg->queue_head + urg->queue_count) % QUEUE_N] = *command;
        urg->queue_count++;
        pump(urg);
    }
    memset(command, 0, sizeof *command);
}

void urg04lx_receive(urg04lx_t *urg, unsigned octet, double bit_ns)
{
    command_t *command = &urg->incoming;

    if (!urg->ready) {
        return;
    }
    if (fabs(bit_ns * urg->line.rate / 1e9 - 1.0) > BIT_TOLERANCE) {
        urg->octets_mismatched++;
        return;
    }
    if (octet == '\n' || octet == '\r') {
        command_complete(urg);
        return;
    }
    command->foreign |= octet < 0x20 || octet > 0x7E || octet == '$';
    if (command->length < COMMAND_N) {
        command->text[command->length] = (char)octet;
    }
    command->length++;
}

void urg04lx_trouble(urg04lx_t *urg, unsigned code)
{
    if (urg->ready) {
        urg->trouble = code;
    }
}

/* The one way from the model's transmitter to the wire. */
static void octet_left(void *context, unsigned octet, double bit_ns)
{
    urg04lx_t *urg = context;

    if (urg->next_rate > 0.0 && serial_idle(&urg->line)) {
        serial_set_rate(&urg->line, urg->next_rate);
        urg->next_rate = 0.0;
        pump(urg);
    }
    urg->sink(urg->sink_context, octet, bit_ns);
}

/* ---- life ---- */

static void booted(void *context)
{
    urg04lx_t *urg = context;

    urg->boot_event = 0;
    urg->ready = true;
    urg->laser_on = true;
}

static void switch_on(urg04lx_t *urg)
{
    urg->powered = true;
    urg->clock_zero = timeline_now();
    urg->first_turn = timeline_now() + urg->config.phase;
    urg->boot_event = timeline_after(urg->config.boot, booted, urg);
}

static void switch_off(urg04lx_t *urg)
{
    timeline_cancel(urg->boot_event);
    timeline_cancel(urg->command_event);
    drop_scan(&urg->single);
    drop_scan(&urg->stream);
    serial_flush(&urg->line);
    serial_set_rate(&urg->line, urg->config.power_up_rate);
    memset(&urg->incoming, 0, sizeof urg->incoming);
    urg->next_rate = 0.0;
    urg->boot_event = urg->command_event = 0;
    urg->queue_count = 0;
    urg->trouble = 0;
    urg->verifying = false;
    urg->powered = urg->ready = urg->scip2 = urg->laser_on = urg->time_mode = urg->answered = false;
}

void urg04lx_power(urg04lx_t *urg, bool on)
{
    if (on == urg->powered) {
        return;
    }
    if (on) {
        switch_on(urg);
    } else {
        switch_off(urg);
    }
}

urg04lx_t *urg04lx_create(const urg04lx_config_t *config, urg_world_t world, void *world_context,
                          serial_sink_t sink, void *sink_context)
{
    urg04lx_t *urg = calloc(1, sizeof *urg);

    if (urg == NULL) {
        abort();
    }
    urg->config = *config;
    urg->world = world;
    urg->world_context = world_context;
    urg->sink = sink;
    urg->sink_context = sink_context;
    urg->single.urg = urg->stream.urg = urg;
    serial_init(&urg->line, config->power_up_rate, octet_left, urg);
    return urg;
}

void urg04lx_destroy(urg04lx_t *urg)
{
    urg04lx_power(urg, false);
    free(urg);
}

urg04lx_state_t urg04lx_state(const urg04lx_t *urg)
{
    return (urg04lx_state_t){
        .powered = urg->powered,
        .scip2 = urg->scip2,
        .streaming = urg->stream.active,
        .time_mode = urg->time_mode,
        .laser_on = urg->laser_on,
        .rate = urg->line.rate,
        .scans_sent = urg->scans_sent,
        .revolutions_skipped = urg->revolutions_skipped,
        .octets_mismatched = urg->octets_mismatched,
        .commands = urg->commands,
        .refused = urg->refused,
    };
}
