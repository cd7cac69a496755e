#include "sim/timeline.h"

#include <stdio.h>
#include <stdlib.h>

/* A binary heap of keys. An id is a running number and the slot that holds the action; ids only ever grow,
 * also across timeline_reset(), so that they order equal times and an old id never matches a new event. */
#define SLOT_BITS 20
#define SLOT_MASK (((timeline_id_t)1 << SLOT_BITS) - 1)

typedef struct {
    sim_time_t when;
    timeline_id_t id;
} heap_key_t;

typedef struct {
    timeline_id_t id; /* 0 when free */
    size_t place;     /* in the heap; the next free slot when free */
    timeline_action_t action;
    void *context;
} slot_t;

static heap_key_t *heap;
static slot_t *slots;
static size_t capacity;
static size_t count;
static size_t free_slot; /* capacity = none */
static sim_time_t now;
static uint64_t last_number;

static void fail(const char *message)
{
    (void)fprintf(stderr, "timeline: %s\n", message);
    abort();
}

static void chain_free_slots(size_t from)
{
    for (size_t i = from; i < capacity; i++) {
        slots[i].id = 0;
        slots[i].place = i + 1;
    }
    free_slot = from;
}

static void grow(void)
{
    size_t from = capacity;

    capacity = capacity == 0 ? 64 : 2 * capacity;
    if (capacity > SLOT_MASK) {
        fail("too many events");
    }
    heap = realloc(heap, capacity * sizeof *heap);
    slots = realloc(slots, capacity * sizeof *slots);
    if (heap == NULL || slots == NULL) {
        fail("out of memory");
    }
    chain_free_slots(from);
}

static void put(size_t place, heap_key_t key)
{
    heap[place] = key;
    slots[key.id & SLOT_MASK].place = place;
}

static bool before(heap_key_t a, heap_key_t b)
{
    return a.when < b.when || (a.when == b.when && a.id < b.id);
}

static void sift_up(size_t place, heap_key_t key)
{
    while (place > 0) {
        size_t parent = (place - 1) / 2;

        if (!before(key, heap[parent])) {
            break;
        }
        put(place, heap[parent]);
        place = parent;
    }
    put(place, key);
}

static void sift_down(size_t place, heap_key_t key)
{
    for (;;) {
        size_t child = 2 * place + 1;

        if (child + 1 < count && before(heap[child + 1], heap[child])) {
            child++;
        }
        if (child >= count || !before(heap[child], key)) {
            break;
        }
        put(place, heap[child]);
        place = child;
    }
    put(place, key);
}

static void take_out(size_t place)
{
    size_t slot = heap[place].id & SLOT_MASK;

    count--;
    if (place != count) {
        heap_key_t last = heap[count];

        if (place > 0 && before(last, heap[(place - 1) / 2])) {
            sift_up(place, last);
        } else {
            sift_down(place, last);
        }
    }
    slots[slot].id = 0;
    slots[slot].place = free_slot;
    free_slot = slot;
}

void timeline_reset(void)
{
    count = 0;
    now = 0;
    chain_free_slots(0);
}

sim_time_t timeline_now(void)
{
    return now;
}

timeline_id_t timeline_at(sim_time_t when, timeline_action_t action, void *context)
{
    if (when < now) {
        fail("an event in the past");
    }
    if (free_slot == capacity) {
        grow();
    }
    size_t slot = free_slot;
    timeline_id_t id = (++last_number << SLOT_BITS) | slot;

    free_slot = slots[slot].place;
    slots[slot] = (slot_t){.id = id, .action = action, .context = context};
    sift_up(count++, (heap_key_t){when, id});
    return id;
}

timeline_id_t timeline_after(sim_time_t delay, timeline_action_t action, void *context)
{
    return timeline_at(now + delay, action, context);
}

bool timeline_cancel(timeline_id_t id)
{
    size_t slot = id & SLOT_MASK;

    if (id == 0 || slot >= capacity || slots[slot].id != id) {
        return false;
    }
    take_out(slots[slot].place);
    return true;
}

sim_time_t timeline_next(void)
{
    return count > 0 ? heap[0].when : SIM_NEVER;
}

void timeline_move_to(sim_time_t when)
{
    if (when < now || when > timeline_next()) {
        fail("a move into the past or over a waiting event");
    }
    now = when;
}

void timeline_run_due(void)
{
    while (count > 0 && heap[0].when <= now) {
        slot_t due = slots[heap[0].id & SLOT_MASK];

        take_out(0);
        due.action(due.context);
    }
}
