/* What the example sketch uses of Arduino's core, declared only: the sketch is compiled, not linked. */
#ifndef ARDUINO_H
#define ARDUINO_H

#include <stddef.h>
#include <stdint.h>

struct HardwareSerial {
    void begin(unsigned long rate);
    int available();
    int read();
    size_t write(const uint8_t *octets, size_t count);
    size_t println(double number);
    size_t println(const char *text);
};
extern HardwareSerial Serial, Serial1;
unsigned long micros();
unsigned long millis();

#endif
