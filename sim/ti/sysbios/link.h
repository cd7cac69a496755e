/* Rings of links: a list is a link that is nobody's element; an element that is alone is in no list. */
#ifndef SIM_TI_SYSBIOS_LINK_H
#define SIM_TI_SYSBIOS_LINK_H

#include <stdbool.h>
#include <stddef.h>

typedef struct link {
    struct link *previous, *next;
} link_t;

/* The object whose member `name` the element is. */
#define LINK_OWNER(element, type, name) ((type *)(void *)((char *)(element)-offsetof(type, name)))

static inline void link_init(link_t *element)
{
    element->previous = element;
    element->next = element;
}

static inline bool link_alone(const link_t *element)
{
    return element->next == element;
}

/* With a list as `place`: at its end. */
static inline void link_before(link_t *place, link_t *element)
{
    element->next = place;
    element->previous = place->previous;
    place->previous->next = element;
    place->previous = element;
}

static inline void link_remove(link_t *element)
{
    element->previous->next = element->next;
    element->next->previous = element->previous;
    link_init(element);
}

#endif
