#include "sci.h"

#include <math.h>
#include <string.h>

#include "inc/hw_ints.h"
#include "pin_map.h"
#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/model.h"
#include "sysctl.h"

#define PORT_COUNT 3U
#define PIN_CHOICES 3U
#define FIFO_DEPTH 16U
#define FRAME_BITS 10     /* 8N1 */
#define STOP_SAMPLE 9.5   /* bits from the start edge */
#define BREAK_BITS 19.625 /* a frame, then 9.625 bits from the missing stop bit on */
#define MAX_MISMATCH 0.045

typedef struct {
    uint16_t words[FIFO_DEPTH];
    unsigned count;
} fifo_t;

typedef struct {
    uint32_t base, clock;
    int receive_interrupt, transmit_interrupt;
    uint32_t receive_pins[PIN_CHOICES], transmit_pins[PIN_CHOICES]; /* pin_map.h words, 0 = none */
} wiring_t;

typedef struct {
    uint16_t ccr, ctl1, brr, rxst, fftx, ffrx; /* without the FIFO levels */
    fifo_t receive, transmit;
    bool receive_line, transmit_line; /* to the interrupt controller, which takes edges */
    double listening_from;            /* a start bit counts from then on */
    bool line_low;                    /* held low from outside */
    timeline_id_t low_event;
    bool shifting;
    unsigned shift;
    sim_time_t shift_start;
    double shift_bit_ns;
    timeline_id_t shift_event;
} registers_t;

typedef struct {
    const wiring_t *wiring;
    registers_t r;
    chip_octet_t transmitted;
    void *context;
} sci_t;

static const wiring_t WIRING[PORT_COUNT] = {
    {SCIA_BASE,
     SYSCTL_PERIPH_CLK_SCIA,
     INT_SCIA_RX >> 16,
     INT_SCIA_TX >> 16,
     {GPIO_64_SCIRXDA, GPIO_43_SCIRXDA, GPIO_85_SCIRXDA},
     {GPIO_65_SCITXDA, GPIO_42_SCITXDA, GPIO_84_SCITXDA}},
    {SCIB_BASE,
     SYSCTL_PERIPH_CLK_SCIB,
     INT_SCIB_RX >> 16,
     INT_SCIB_TX >> 16,
     {GPIO_87_SCIRXDB},
     {GPIO_86_SCITXDB}},
    {SCIC_BASE,
     SYSCTL_PERIPH_CLK_SCIC,
     INT_SCIC_RX >> 16,
     INT_SCIC_TX >> 16,
     {GPIO_90_SCIRXDC},
     {GPIO_89_SCITXDC}},
};

static sci_t ports[PORT_COUNT];
static struct {
    chip_octet_t transmitted;
    void *context;
} usb;
static void (*raise_interrupt)(int interrupt);

static void update(sci_t *sci);

/* ---- state ---- */

static sci_t *at(uint32_t base)
{
    const uint32_t index = (base - SCIA_BASE) / (SCIB_BASE - SCIA_BASE);
    if (index >= PORT_COUNT || WIRING[index].base != base) {
        chip_unmodelled("no SCI at this base");
    }
    return &ports[index];
}

static bool clocked(const sci_t *sci)
{
    return sysctl_clocked(sci->wiring->clock);
}

static double bit_ns(const sci_t *sci)
{
    const double clocks = sci->r.brr == 0 ? 16.0 : 8.0 * (sci->r.brr + 1);
    return clocks * 1e9 / sysctl_lspclk_hz();
}

static bool running(const sci_t *sci, uint16_t enable)
{
    return clocked(sci) && (sci->r.ctl1 & SCI_CTL1_SWRESET) != 0 && (sci->r.ctl1 & enable) != 0 &&
           (sci->r.fftx & SCI_FFTX_SCIFFENA) != 0 && (sci->r.fftx & SCI_FFTX_SCIRST) != 0;
}

static bool receiving(const sci_t *sci)
{
    return running(sci, SCI_CTL1_RXENA) && (sci->r.ffrx & SCI_FFRX_RXFIFORESET) != 0 &&
           (sci->r.rxst & SCI_RXST_BRKDT) == 0;
}

static bool transmitting(const sci_t *sci)
{
    return running(sci, SCI_CTL1_TXENA) && (sci->r.fftx & SCI_FFTX_TXFIFORESET) != 0;
}

static bool wired(const uint32_t *pins)
{
    for (unsigned i = 0; i < PIN_CHOICES && pins[i] != 0; i++) {
        if (gpio_routed(pins[i])) {
            return true;
        }
    }
    return false;
}

/* Each pin that is the transmitter's puts the octet out: the USB port's to it, a header's to the device. */
static void put_out(const sci_t *sci)
{
    const uint32_t *pins = sci->wiring->transmit_pins;
    bool header = false;

    for (unsigned i = 0; i < PIN_CHOICES && pins[i] != 0; i++) {
        if (!gpio_routed(pins[i])) {
            continue;
        }
        if (pins[i] != GPIO_84_SCITXDA) {
            header = true;
        } else if (usb.transmitted != NULL) {
            usb.transmitted(usb.context, sci->r.shift, sci->r.shift_bit_ns);
        }
    }
    if (header && sci->transmitted != NULL) {
        sci->transmitted(sci->context, sci->r.shift, sci->r.shift_bit_ns);
    }
}

static uint16_t fifo_take(fifo_t *fifo)
{
    if (fifo->count == 0) {
        return 0;
    }
    const uint16_t word = fifo->words[0];
    fifo->count--;
    memmove(fifo->words, fifo->words + 1, fifo->count * sizeof fifo->words[0]);
    return word;
}

static void fifo_put(fifo_t *fifo, unsigned word)
{
    fifo->words[fifo->count] = (uint16_t)word;
    fifo->count++;
}

/* ---- interrupts ---- */

static void line(bool *line, bool level, int interrupt)
{
    const bool rises = level && !*line;
    *line = level;
    if (rises && raise_interrupt != NULL) {
        raise_interrupt(interrupt);
    }
}

static bool error_pending(const registers_t *r)
{
    return (r->rxst & SCI_RXST_RXERROR) != 0 && (r->ctl1 & SCI_CTL1_RXERRINTENA) != 0;
}

/* The FIFO's receive interrupt and the receive errors share one line: while one holds it up, the other makes
 * no edge. */
static void update_interrupts(sci_t *sci)
{
    registers_t *r = &sci->r;
    const bool fifos = (r->fftx & SCI_FFTX_SCIFFENA) != 0;
    if (fifos && r->receive.count >= (r->ffrx & SCI_FFRX_RXFFIL_M)) {
        r->ffrx |= SCI_FFRX_RXFFINT;
    }
    if (fifos && r->transmit.count <= (r->fftx & SCI_FFTX_TXFFIL_M)) {
        r->fftx |= SCI_FFTX_TXFFINT;
    }
    const uint16_t rxff = SCI_FFRX_RXFFINT | SCI_FFRX_RXFFIENA;
    const uint16_t txff = SCI_FFTX_TXFFINT | SCI_FFTX_TXFFIENA;
    line(&r->receive_line, (r->ffrx & (rxff | SCI_FFRX_RXFFOVF)) == rxff || error_pending(r),
         sci->wiring->receive_interrupt);
    line(&r->transmit_line, (r->fftx & txff) == txff, sci->wiring->transmit_interrupt);
}

/* ---- transmitter ---- */

static void shifted_out(void *context)
{
    sci_t *sci = context;
    sci->r.shift_event = 0;
    sci->r.shifting = false;
    put_out(sci);
    update(sci);
}

static void start_shifting(sci_t *sci)
{
    registers_t *r = &sci->r;
    if (r->shifting || r->transmit.count == 0 || !transmitting(sci)) {
        return;
    }
    r->shifting = true;
    r->shift = fifo_take(&r->transmit) & 0xFFU;
    r->shift_start = timeline_now();
    r->shift_bit_ns = bit_ns(sci);
    r->shift_event = timeline_after(llround(FRAME_BITS * r->shift_bit_ns), shifted_out, sci);
}

/* The line goes to mark at once: the far end reads ones for the rest, or nothing when no whole start bit was
 * out. */
static void cut_short(sci_t *sci)
{
    registers_t *r = &sci->r;
    if (!r->shifting) {
        return;
    }
    const double bits = (double)(timeline_now() - r->shift_start) / r->shift_bit_ns;
    timeline_cancel(r->shift_event);
    if (bits < 0.5) {
        r->shift_event = 0;
        r->shifting = false;
        return;
    }
    const unsigned sent = bits < 1.0 ? 0U : (unsigned)bits - 1U;
    r->shift |= 0xFFU << sent & 0xFFU;
    shifted_out(sci);
}

static void update(sci_t *sci)
{
    start_shifting(sci);
    update_interrupts(sci);
}

/* ---- receiver ---- */

static void received(sci_t *sci, unsigned octet, bool framing_error)
{
    registers_t *r = &sci->r;
    if (r->receive.count == FIFO_DEPTH) {
        (void)fifo_take(&r->receive);
        r->ffrx |= SCI_FFRX_RXFFOVF;
    }
    fifo_put(&r->receive, octet | (framing_error ? SCI_RXBUF_SCIFFFE : 0U));
    if (framing_error) {
        r->rxst |= SCI_RXST_FE | SCI_RXST_RXERROR;
    }
    update(sci);
}

static void broken(sci_t *sci)
{
    sci->r.rxst |= SCI_RXST_BRKDT | SCI_RXST_RXERROR;
    update(sci);
}

/* A frame on the wire: start bit, octet, then mark. */
typedef struct {
    unsigned octet;
    double start, bit;
} frame_t;

static bool frame_bit(const frame_t *frame, int index)
{
    return index != 0 && (index < 0 || index > 8 || (frame->octet >> (index - 1) & 1U) != 0);
}

static bool frame_level(const frame_t *frame, double when)
{
    return frame_bit(frame, (int)floor((when - frame->start) / frame->bit));
}

/* First instant at or after `from` with the line low; false when there is none. */
static bool frame_low(const frame_t *frame, double from, double *when)
{
    const int first = from <= frame->start ? 0 : (int)floor((from - frame->start) / frame->bit);
    for (int i = first; i < FRAME_BITS; i++) {
        if (!frame_bit(frame, i)) {
            *when = fmax(from, frame->start + i * frame->bit);
            return true;
        }
    }
    return false;
}

static double longest_low(const frame_t *frame)
{
    int longest = 0;
    for (int i = 0, run = 0; i < FRAME_BITS; i++) {
        run = frame_bit(frame, i) ? 0 : run + 1;
        longest = run > longest ? run : longest;
    }
    return longest * frame->bit;
}

/* Whether every sample of a frame falls into its own bit: then the receiver reads what was sent, and is not
 * asked for each of them. Up to the mismatch it tolerates, 9.5 bits are off by less than half a bit. */
static bool clean(const sci_t *sci, const frame_t *frame)
{
    return sci->r.listening_from <= frame->start && fabs(frame->bit / bit_ns(sci) - 1.0) <= MAX_MISMATCH;
}

static void sample(sci_t *sci, const frame_t *frame)
{
    const double own = bit_ns(sci);
    const bool mismatch = fabs(frame->bit / own - 1.0) > MAX_MISMATCH;
    double t = sci->r.listening_from;
    while (receiving(sci) && frame_low(frame, t, &t)) {
        if (frame_level(frame, t + 0.5 * own)) {
            t += 0.5 * own;
            continue;
        }
        unsigned octet = 0;
        for (int bit = 0; bit < 8; bit++) {
            octet |= (unsigned)frame_level(frame, t + (1.5 + bit) * own) << bit;
        }
        t += STOP_SAMPLE * own;
        sci->r.listening_from = t;
        received(sci, octet, mismatch || !frame_level(frame, t));
    }
}

void chip_sci_receive(uint32_t base, unsigned octet, double bit)
{
    sci_t *sci = at(base);
    const frame_t frame = {octet & 0xFFU, (double)timeline_now() - FRAME_BITS * bit, bit};
    if (sci->r.line_low || !receiving(sci) || !wired(sci->wiring->receive_pins)) {
        return;
    }
    if (clean(sci, &frame)) {
        sci->r.listening_from = frame.start + STOP_SAMPLE * bit_ns(sci);
        received(sci, frame.octet, false);
        return;
    }
    sample(sci, &frame);
    if (receiving(sci) && longest_low(&frame) >= BREAK_BITS * bit_ns(sci)) {
        broken(sci);
    }
}

/* A line held low: first a frame without stop bit, later a break. */
static void low_for_a_break(void *context)
{
    sci_t *sci = context;
    sci->r.low_event = 0;
    if (receiving(sci)) {
        broken(sci);
    }
}

static void low_for_a_frame(void *context)
{
    sci_t *sci = context;
    const double rest = (BREAK_BITS - STOP_SAMPLE) * bit_ns(sci);
    sci->r.low_event = timeline_after(llround(rest), low_for_a_break, sci);
    if (receiving(sci)) {
        received(sci, 0, true);
    }
}

static void watch_low(sci_t *sci)
{
    if (sci->r.low_event != 0) {
        timeline_cancel(sci->r.low_event);
        sci->r.low_event = 0;
    }
    if (sci->r.line_low && receiving(sci)) {
        sci->r.low_event = timeline_after(llround(STOP_SAMPLE * bit_ns(sci)), low_for_a_frame, sci);
    }
}

void sci_lines_changed(void)
{
    for (unsigned i = 0; i < PORT_COUNT; i++) {
        sci_t *sci = &ports[i];
        const uint32_t *pins = WIRING[i].receive_pins;
        bool low = false;
        for (unsigned k = 0; k < PIN_CHOICES && pins[k] != 0; k++) {
            low = low || (gpio_routed(pins[k]) && !gpio_input(pins[k]));
        }
        if (low != sci->r.line_low) {
            sci->r.line_low = low;
            sci->r.listening_from = (double)timeline_now();
            watch_low(sci);
        }
    }
}

static void listen(sci_t *sci)
{
    sci->r.listening_from = (double)timeline_now();
    watch_low(sci);
    update(sci);
}

/* ---- the world ---- */

void sci_reset(void (*raise)(int interrupt))
{
    raise_interrupt = raise;
    for (unsigned i = 0; i < PORT_COUNT; i++) {
        registers_t *r = &ports[i].r;
        if (r->shift_event != 0) {
            timeline_cancel(r->shift_event);
        }
        if (r->low_event != 0) {
            timeline_cancel(r->low_event);
        }
        *r = (registers_t){.fftx = SCI_FFTX_SCIRST | SCI_FFTX_TXFIFORESET,
                           .ffrx = SCI_FFRX_RXFIFORESET | SCI_FFRX_RXFFIL_M};
        ports[i].wiring = &WIRING[i];
    }
}

void chip_sci_connect(uint32_t base, chip_octet_t transmitted, void *context)
{
    at(base)->transmitted = transmitted;
    at(base)->context = context;
}

void chip_usb_connect(chip_octet_t transmitted, void *context)
{
    usb.transmitted = transmitted;
    usb.context = context;
}

double chip_sci_rate(uint32_t base)
{
    const sci_t *sci = at(base);
    return clocked(sci) && (sci->r.ctl1 & SCI_CTL1_SWRESET) != 0 ? 1e9 / bit_ns(sci) : 0.0;
}

bool sci_drives(uint32_t pin, bool *level)
{
    for (unsigned i = 0; i < PORT_COUNT; i++) {
        const uint32_t *pins = WIRING[i].transmit_pins;
        for (unsigned k = 0; k < PIN_CHOICES && pins[k] != 0; k++) {
            if (gpio_pin(pins[k]) == pin && gpio_routed(pins[k])) {
                const registers_t *r = &ports[i].r;
                const frame_t frame = {r->shift, (double)r->shift_start, r->shift_bit_ns};
                *level = !r->shifting || frame_level(&frame, (double)timeline_now());
                return true;
            }
        }
    }
    return false;
}

static uint16_t read_register(const sci_t *sci, uint32_t offset)
{
    const registers_t *r = &sci->r;
    switch (offset) {
    case SCI_O_CCR:
        return r->ccr;
    case SCI_O_CTL1:
        return r->ctl1;
    case SCI_O_HBAUD:
        return r->brr >> 8;
    case SCI_O_LBAUD:
        return r->brr & 0xFFU;
    case SCI_O_CTL2:
        return (uint16_t)((r->transmit.count == 0 && !r->shifting ? SCI_CTL2_TXEMPTY : 0U) |
                          (r->transmit.count < FIFO_DEPTH ? SCI_CTL2_TXRDY : 0U));
    case SCI_O_RXST:
        return (uint16_t)(r->rxst | (r->receive.count > 0 ? SCI_RXST_RXRDY : 0U));
    case SCI_O_FFTX:
        return (uint16_t)(r->fftx | r->transmit.count << SCI_FFTX_TXFFST_S);
    case SCI_O_FFRX:
        return (uint16_t)(r->ffrx | r->receive.count << SCI_FFRX_RXFFST_S);
    default:
        chip_unmodelled("no such SCI register");
    }
}

const volatile uint16_t *driverlib_halfword(uint32_t address)
{
    static uint16_t value;
    const sci_t *sci = at(address & ~0xFU);
    value = clocked(sci) ? read_register(sci, address & 0xFU) : 0;
    return &value;
}

bool sci_register(const char *name, uint32_t *value)
{
    static const struct {
        const char *name;
        uint32_t offset;
    } words[] = {{"CCR", SCI_O_CCR},   {"CTL1", SCI_O_CTL1}, {"CTL2", SCI_O_CTL2},
                 {"RXST", SCI_O_RXST}, {"FFTX", SCI_O_FFTX}, {"FFRX", SCI_O_FFRX}};
    if (strncmp(name, "SCI", 3) != 0 || name[3] < 'A' || name[3] > 'C' || name[4] != '.') {
        return false;
    }
    const sci_t *sci = &ports[name[3] - 'A'];
    if (strcmp(name + 5, "BRR") == 0) {
        *value = sci->r.brr;
        return true;
    }
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (strcmp(name + 5, words[i].name) == 0) {
            *value = read_register(sci, words[i].offset);
            return true;
        }
    }
    return false;
}

/* ---- driverlib ---- */

/* Registers behind a closed clock gate: what is written there is lost. */
static sci_t *reach(uint32_t base)
{
    static sci_t nowhere;
    sci_t *sci = at(base);
    if (clocked(sci)) {
        return sci;
    }
    nowhere = (sci_t){.wiring = sci->wiring};
    return &nowhere;
}

void SCI_enableModule(uint32_t base)
{
    sci_t *sci = reach(base);
    sci->r.ctl1 |= SCI_CTL1_TXENA | SCI_CTL1_RXENA | SCI_CTL1_SWRESET;
    listen(sci);
}

void SCI_disableModule(uint32_t base)
{
    registers_t *r = &reach(base)->r;
    r->fftx &= (uint16_t)~SCI_FFTX_SCIFFENA;
    r->ctl1 &= (uint16_t) ~(SCI_CTL1_TXENA | SCI_CTL1_RXENA);
}

void SCI_setConfig(uint32_t base, uint32_t lspclkHz, uint32_t baud, uint32_t config)
{
    if (baud == 0 || baud * 16U > lspclkHz) {
        chip_unmodelled("SCI_setConfig: TI's assertion on the rate fails");
    }
    if (config != (SCI_CONFIG_WLEN_8 | SCI_CONFIG_STOP_ONE | SCI_CONFIG_PAR_NONE)) {
        chip_unmodelled("only 8N1");
    }
    SCI_disableModule(base);
    reach(base)->r.brr = (uint16_t)(lspclkHz / (baud * 8U) - 1U);
    reach(base)->r.ccr = (uint16_t)config;
    SCI_enableModule(base);
}

void SCI_setBaud(uint32_t base, uint32_t lspclkHz, uint32_t baud)
{
    reach(base)->r.brr = (uint16_t)((float)lspclkHz / ((float)baud * 8.0F) - 1.0F + 0.5F);
}

void SCI_performSoftwareReset(uint32_t base)
{
    sci_t *sci = reach(base);
    cut_short(sci);
    sci->r.rxst = 0;
    update_interrupts(sci);
    sci->r.ctl1 |= SCI_CTL1_SWRESET;
    listen(sci);
}

void SCI_resetChannels(uint32_t base)
{
    sci_t *sci = reach(base);
    cut_short(sci);
    sci->r.fftx |= SCI_FFTX_SCIRST;
    listen(sci);
}

void SCI_enableFIFO(uint32_t base)
{
    sci_t *sci = reach(base);
    sci->r.fftx |= SCI_FFTX_SCIRST | SCI_FFTX_SCIFFENA | SCI_FFTX_TXFIFORESET;
    sci->r.ffrx |= SCI_FFRX_RXFIFORESET;
    watch_low(sci);
    update(sci);
}

void SCI_resetRxFIFO(uint32_t base)
{
    sci_t *sci = reach(base);
    sci->r.receive.count = 0;
    sci->r.ffrx |= SCI_FFRX_RXFIFORESET;
    update(sci);
}

void SCI_resetTxFIFO(uint32_t base)
{
    sci_t *sci = reach(base);
    sci->r.transmit.count = 0;
    sci->r.fftx |= SCI_FFTX_TXFIFORESET;
    update(sci);
}

void SCI_setFIFOInterruptLevel(uint32_t base, SCI_TxFIFOLevel txLevel, SCI_RxFIFOLevel rxLevel)
{
    sci_t *sci = reach(base);
    sci->r.fftx = (uint16_t)((sci->r.fftx & ~SCI_FFTX_TXFFIL_M) | txLevel);
    sci->r.ffrx = (uint16_t)((sci->r.ffrx & ~SCI_FFRX_RXFFIL_M) | rxLevel);
    update(sci);
}

SCI_TxFIFOLevel SCI_getTxFIFOStatus(uint32_t base)
{
    return (SCI_TxFIFOLevel)reach(base)->r.transmit.count;
}

SCI_RxFIFOLevel SCI_getRxFIFOStatus(uint32_t base)
{
    return (SCI_RxFIFOLevel)reach(base)->r.receive.count;
}

bool SCI_isTransmitterBusy(uint32_t base)
{
    return reach(base)->r.transmit.count != 0;
}

void SCI_writeCharNonBlocking(uint32_t base, uint16_t data)
{
    sci_t *sci = reach(base);
    if (transmitting(sci) && sci->r.transmit.count < FIFO_DEPTH) {
        fifo_put(&sci->r.transmit, data);
        update(sci);
    }
}

uint16_t SCI_readCharNonBlocking(uint32_t base)
{
    return fifo_take(&reach(base)->r.receive) & SCI_RXBUF_SAR_M;
}

static void set_enables(sci_t *sci, uint32_t flags, bool on)
{
    registers_t *r = &sci->r;
    if ((flags & ~(SCI_INT_RXERR | SCI_INT_TXFF | SCI_INT_RXFF)) != 0) {
        chip_unmodelled("only the SCI interrupts RXFF, TXFF and RXERR");
    }
    const uint16_t ctl1 = (flags & SCI_INT_RXERR) != 0 ? SCI_CTL1_RXERRINTENA : 0;
    const uint16_t fftx = (flags & SCI_INT_TXFF) != 0 ? SCI_FFTX_TXFFIENA : 0;
    const uint16_t ffrx = (flags & SCI_INT_RXFF) != 0 ? SCI_FFRX_RXFFIENA : 0;
    r->ctl1 = (uint16_t)(on ? r->ctl1 | ctl1 : r->ctl1 & ~ctl1);
    r->fftx = (uint16_t)(on ? r->fftx | fftx : r->fftx & ~fftx);
    r->ffrx = (uint16_t)(on ? r->ffrx | ffrx : r->ffrx & ~ffrx);
    update(sci);
}

void SCI_enableInterrupt(uint32_t base, uint32_t intFlags)
{
    set_enables(reach(base), intFlags, true);
}

void SCI_disableInterrupt(uint32_t base, uint32_t intFlags)
{
    set_enables(reach(base), intFlags, false);
}

void SCI_clearInterruptStatus(uint32_t base, uint32_t intFlags)
{
    sci_t *sci = reach(base);
    if ((intFlags & (SCI_INT_RXERR | SCI_INT_RXRDY_BRKDT | SCI_INT_FE | SCI_INT_OE | SCI_INT_PE)) != 0) {
        SCI_performSoftwareReset(base);
    }
    if ((intFlags & SCI_INT_TXFF) != 0) {
        sci->r.fftx &= (uint16_t)~SCI_FFTX_TXFFINT;
        sci->r.transmit_line = false;
    }
    if ((intFlags & SCI_INT_RXFF) != 0) {
        sci->r.ffrx &= (uint16_t)~SCI_FFRX_RXFFINT;
        sci->r.receive_line = error_pending(&sci->r);
    }
    update(sci);
}

uint16_t SCI_getRxStatus(uint32_t base)
{
    return read_register(reach(base), SCI_O_RXST);
}

bool SCI_getOverflowStatus(uint32_t base)
{
    return (reach(base)->r.ffrx & SCI_FFRX_RXFFOVF) != 0;
}

void SCI_clearOverflowStatus(uint32_t base)
{
    sci_t *sci = reach(base);
    sci->r.ffrx &= (uint16_t)~SCI_FFRX_RXFFOVF;
    update(sci);
}
