#ifndef STREAM_BUFFER_H
#define STREAM_BUFFER_H

typedef struct StreamBufferDef_t *StreamBufferHandle_t;
typedef struct {
    void *unused[12];
} StaticStreamBuffer_t;

StreamBufferHandle_t xStreamBufferCreateStatic(size_t size, size_t trigger, uint8_t *storage,
                                               StaticStreamBuffer_t *buffer);
size_t xStreamBufferReceive(StreamBufferHandle_t buffer, void *octets, size_t most, TickType_t wait);
size_t xStreamBufferSendFromISR(StreamBufferHandle_t buffer, const void *octets, size_t count,
                                BaseType_t *woken);

#endif
