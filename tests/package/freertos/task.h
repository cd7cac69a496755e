#ifndef TASK_H
#define TASK_H

typedef void *TaskHandle_t;
typedef void (*TaskFunction_t)(void *);
typedef struct {
    void *unused[24];
} StaticTask_t;

TickType_t xTaskGetTickCount(void);
void vTaskDelete(TaskHandle_t task);
TaskHandle_t xTaskCreateStatic(TaskFunction_t code, const char *name, uint32_t depth, void *parameter,
                               UBaseType_t priority, StackType_t *stack, StaticTask_t *control);

#endif
