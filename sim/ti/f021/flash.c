#include "sim/ti/f021/flash.h"

#include <errno.h>
#include <limits.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/cpu.h"
#include "sim/ti/driverlib/flash.h"
#include "sim/ti/f021/include/F021_F2837xS_C28x.h"

#define BLOCK 8
#define BLANK 0xFFFFU
#define HALF_DONE 0x5A5AU
#define FILE_OCTETS ((size_t)FLASH_SECTORS * FLASH_SECTOR_CELLS * 2)
#define FSM_FAILED 0x30U
/* Of the library's code that sets up the flash state machine (F021 1.55): it turns six times in OTP into
 * pulse widths, calls back within each, and stores 39 values in protected registers after the first call. */
#define CALLS_BACK 6
#define SETUP_STORES 39
#define CODE_CELLS 0x400

/* The linker command file of the target gives it its address. */
extern uint16_t flash_sectors_m_n[FLASH_SECTORS][FLASH_SECTOR_CELLS];
uint16_t flash_sectors_m_n[FLASH_SECTORS][FLASH_SECTOR_CELLS] = {
    [0 ... FLASH_SECTORS - 1] = {[0 ... FLASH_SECTOR_CELLS - 1] = BLANK},
};

/* And this one: what lies in the bank and never changes. */
extern const volatile uint16_t flash_code[CODE_CELLS];
const volatile uint16_t flash_code[CODE_CELLS];

Fapi_FmcRegistersType f021_registers;

static struct {
    bool programmed[FLASH_SECTORS][FLASH_SECTOR_CELLS / BLOCK];
    bool pump, initialised, active, busy;
    bool uncorrected; /* the error correction is off, */
    bool written_off; /* and was written so: in force behind FLASH_DELAY_CONFIG */
    int set_up;       /* of the stores that set up the state machine: those that took effect */
    Fapi_FlashStatusType status;
    bool cut;
    long left; /* cells until the power fails, when cut */
    long changed;
} flash;

void flash_blank(void)
{
    memset(flash_sectors_m_n, 0xFF, sizeof flash_sectors_m_n);
    memset(&flash, 0, sizeof flash);
}

static void find_programmed(void)
{
    for (int sector = 0; sector < FLASH_SECTORS; sector++) {
        for (int cell = 0; cell < FLASH_SECTOR_CELLS; cell++) {
            bool *programmed = &flash.programmed[sector][cell / BLOCK];

            *programmed = (cell % BLOCK != 0 && *programmed) || flash_sectors_m_n[sector][cell] != BLANK;
        }
    }
}

/* The octets of a file, or what is wrong. */
static const char *read_octets(FILE *file, unsigned char octets[FILE_OCTETS])
{
    const size_t count = fread(octets, 1, FILE_OCTETS, file);
    const bool longer = count == FILE_OCTETS && fgetc(file) != EOF;

    if (ferror(file)) {
        return strerror(errno);
    }
    return count != FILE_OCTETS || longer ? "no image of the storage: its length is not 32768 octets" : NULL;
}

const char *flash_load(const char *path)
{
    static unsigned char octets[FILE_OCTETS];
    uint16_t *cells = flash_sectors_m_n[0];
    FILE *file = fopen(path, "rb");
    const char *error;

    if (file == NULL) {
        if (errno != ENOENT) {
            return strerror(errno);
        }
        flash_blank();
        return NULL;
    }
    error = read_octets(file, octets);
    fclose(file);
    if (error != NULL) {
        return error;
    }
    for (size_t i = 0; i < FILE_OCTETS / 2; i++) {
        cells[i] = (uint16_t)(octets[2 * i] | octets[2 * i + 1] << 8);
    }
    find_programmed();
    return NULL;
}

void flash_read_all(unsigned short cells[FLASH_SECTORS * FLASH_SECTOR_CELLS])
{
    memcpy(cells, flash_sectors_m_n[0], FILE_OCTETS);
}

void flash_write_all(const unsigned short cells[FLASH_SECTORS * FLASH_SECTOR_CELLS])
{
    memcpy(flash_sectors_m_n[0], cells, FILE_OCTETS);
    find_programmed();
}

static bool write_cells(FILE *file)
{
    const uint16_t *cells = flash_sectors_m_n[0];

    for (size_t i = 0; i < FILE_OCTETS / 2; i++) {
        if (fputc(cells[i] & 0xFF, file) == EOF || fputc(cells[i] >> 8, file) == EOF) {
            return false;
        }
    }
    return fflush(file) == 0 && fsync(fileno(file)) == 0;
}

/* A new file, whole and on the disk, or what failed; then there is none. */
static const char *write_new(const char *path)
{
    FILE *file = fopen(path, "wb");
    const char *error = NULL;

    if (file == NULL) {
        return strerror(errno);
    }
    if (!write_cells(file)) {
        error = strerror(errno);
    }
    if (fclose(file) != 0 && error == NULL) {
        error = strerror(errno);
    }
    if (error != NULL) {
        (void)remove(path);
    }
    return error;
}

const char *flash_store(const char *path)
{
    char target[PATH_MAX], fresh[PATH_MAX + 32];
    const char *error;

    if (realpath(path, target) == NULL) { /* a link is kept, and what it names replaced */
        if (errno != ENOENT || strlen(path) >= sizeof target) {
            return strerror(errno);
        }
        strcpy(target, path);
    }
    snprintf(fresh, sizeof fresh, "%s.%ld.new", target, (long)getpid());
    error = write_new(fresh);
    if (error == NULL && rename(fresh, target) != 0) {
        error = strerror(errno);
        (void)remove(fresh);
    }
    return error;
}

void flash_cut_power_after(long cells)
{
    flash.cut = cells >= 0;
    flash.left = cells;
}

long flash_cells_changed(void)
{
    return flash.changed;
}

/* False when the power has failed. */
static bool change(uint16_t *cell, uint16_t value)
{
    if (flash.cut && flash.left <= 0) {
        if (flash.left == 0) {
            *cell = (uint16_t)((*cell & HALF_DONE) | (value & (uint16_t)~HALF_DONE));
            flash.left = -1;
        }
        return false;
    }
    flash.left -= flash.cut;
    flash.changed++;
    *cell = value;
    return true;
}

/* A store of the library to one of the flash's protected registers: does it take effect? */
static bool stored(void)
{
    return chip_protected_writable();
}

static void set_up_state_machine(void)
{
    EALLOW;
    flash.set_up = 0;
    for (int call = 0; call < CALLS_BACK; call++) {
        EALLOW;
        (void)Fapi_serviceWatchdogTimer();
        flash.set_up += stored();
    }
    for (int store = CALLS_BACK; store < SETUP_STORES; store++) {
        flash.set_up += stored();
    }
}

static bool ready(void)
{
    return flash.pump && flash.initialised && flash.active && !flash.busy;
}

/* A state machine with some of its pulse widths and voltages as after reset: that it then fails is the
 * model's choice, TI does not say what it does. */
static Fapi_FlashStatusType begin_operation(void)
{
    EALLOW;
    flash.busy = true;
    return flash.set_up == SETUP_STORES ? 0U : FSM_FAILED;
}

/* The sector of an address and the cell in it; -1: not in these sectors. */
static int sector_of(const void *address, int *cell)
{
    ptrdiff_t at = ((const char *)address - (const char *)flash_sectors_m_n) / (ptrdiff_t)sizeof(uint16_t);

    *cell = (int)(at % FLASH_SECTOR_CELLS);
    return at < 0 || at >= FLASH_SECTORS * FLASH_SECTOR_CELLS ? -1 : (int)(at / FLASH_SECTOR_CELLS);
}

void Flash_claimPumpSemaphore(uint32_t pumpSemBase, Flash_PumpOwnership wrapper)
{
    EALLOW;
    flash.pump = pumpSemBase == FLASHPUMPSEMAPHORE_BASE && wrapper == FLASH_BANK0_WRAPPER;
    EDIS;
}

void Flash_releasePumpSemaphore(uint32_t pumpSemBase)
{
    EALLOW;
    (void)pumpSemBase;
    flash.pump = false;
    EDIS;
}

void Flash_enableECC(uint32_t eccBase)
{
    EALLOW;
    flash.written_off = flash.written_off && eccBase != FLASH0ECC_BASE;
    EDIS;
}

void Flash_disableECC(uint32_t eccBase)
{
    EALLOW;
    flash.written_off = flash.written_off || eccBase == FLASH0ECC_BASE;
    EDIS;
}

void driverlib_flash_delay(void)
{
    flash.uncorrected = flash.written_off;
}

bool flash_corrects(void)
{
    return !flash.uncorrected;
}

/* TI's own cells: on some parts their correction bits are wrong. */
static bool otp_readable(void)
{
    if (!flash.uncorrected) {
        chip_nmi();
    }
    return flash.uncorrected;
}

Fapi_StatusType Fapi_initializeAPI(Fapi_FmcRegistersType *poFlashControlRegister, uint32 u32HclkFrequency)
{
    EALLOW;
    flash.initialised = poFlashControlRegister == F021_CPU0_W0_BASE_ADDRESS && u32HclkFrequency == 200U;
    return flash.initialised ? Fapi_Status_Success : Fapi_Error_InvalidHclkValue;
}

Fapi_StatusType Fapi_setActiveFlashBank(Fapi_FlashBankType oNewFlashBank)
{
    EALLOW;
    if (!otp_readable()) {
        return Fapi_Error_Fail;
    }
    flash.active = oNewFlashBank == Fapi_FlashBank0;
    if (flash.active) {
        set_up_state_machine();
    }
    return flash.active ? Fapi_Status_Success : Fapi_Error_InvalidBank;
}

Fapi_StatusType Fapi_issueAsyncCommandWithAddress(Fapi_FlashStateCommandsType oCommand,
                                                  uint32 *pu32StartAddress)
{
    int cell, sector = sector_of(pu32StartAddress, &cell);

    if (!ready() || oCommand != Fapi_EraseSector) {
        return Fapi_Error_Fail;
    }
    if (sector < 0) {
        return Fapi_Error_InvalidAddress;
    }
    flash.status = begin_operation();
    for (cell = 0;
         flash.status == 0 && cell < FLASH_SECTOR_CELLS && change(&flash_sectors_m_n[sector][cell], BLANK);
         cell++) {
    }
    if (cell < FLASH_SECTOR_CELLS) {
        flash.status = FSM_FAILED;
    }
    find_programmed();
    return Fapi_Status_Success;
}

Fapi_StatusType Fapi_issueProgrammingCommand(uint32 *pu32StartAddress, uint16 *pu16DataBuffer,
                                             uint16 u16DataBufferSizeInWords, uint16 *pu16EccBuffer,
                                             uint16 u16EccBufferSizeInBytes,
                                             Fapi_FlashProgrammingCommandsType oMode)
{
    int cell, sector = sector_of(pu32StartAddress, &cell);
    bool *programmed;

    if (!ready() || oMode != Fapi_AutoEccGeneration || pu16EccBuffer != NULL ||
        u16EccBufferSizeInBytes != 0) {
        return Fapi_Error_Fail;
    }
    if (sector < 0 || cell % BLOCK != 0) {
        return Fapi_Error_InvalidAddress;
    }
    if (u16DataBufferSizeInWords != BLOCK) {
        return Fapi_Error_AsyncIncorrectDataBufferLength;
    }
    programmed = &flash.programmed[sector][cell / BLOCK];
    flash.status = begin_operation() != 0U || *programmed ? FSM_FAILED : 0U;
    *programmed = true;
    for (int i = 0; i < BLOCK && flash.status == 0U; i++) {
        uint16_t *at = &flash_sectors_m_n[sector][cell + i];

        if (!change(at, *at & pu16DataBuffer[i])) {
            flash.status = FSM_FAILED;
        }
    }
    return Fapi_Status_Success;
}

Fapi_StatusType Fapi_checkFsmForReady(void)
{
    Fapi_StatusType status = flash.busy ? Fapi_Status_FsmBusy : Fapi_Status_FsmReady;

    flash.busy = false;
    return status;
}

Fapi_FlashStatusType Fapi_getFsmStatus(void)
{
    return flash.status;
}

/* Reads 0C2000H, 0C2100H, 0C2200H and 0C2300H, of bank 1; SYS/BIOS starts bank 0 only. */
void Fapi_flushPipeline(void)
{
    chip_nmi();
}
