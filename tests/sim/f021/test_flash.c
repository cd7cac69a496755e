#include "sim/ti/f021/flash.h"

#include <dirent.h>
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sim/ti/driverlib/chip.h"
#include "sim/ti/driverlib/cpu.h"
#include "sim/ti/driverlib/flash.h"
#include "sim/ti/f021/include/F021_F2837xS_C28x.h"
#include "sim/timeline.h"
#include "unity.h"

extern uint16_t flash_sectors_m_n[FLASH_SECTORS][FLASH_SECTOR_CELLS];

static const char path[] = SCRATCH "/flash.bin";
static uint16_t block[8] = {1, 2, 3, 4, 5, 6, 7, 8};

static int called_back;
static int closes_at; /* the call that ends with EDIS, 0: none does */

Fapi_StatusType Fapi_serviceWatchdogTimer(void)
{
    called_back++;
    if (called_back == closes_at) {
        EDIS;
    }
    return Fapi_Status_Success;
}

void setUp(void)
{
    timeline_reset();
    chip_reset(NULL);
    called_back = closes_at = 0;
    flash_blank();
    (void)remove(path);
}

void tearDown(void)
{
    (void)remove(path);
}

static void start(void)
{
    Flash_claimPumpSemaphore(FLASHPUMPSEMAPHORE_BASE, FLASH_BANK0_WRAPPER);
    Flash_disableECC(FLASH0ECC_BASE);
    FLASH_DELAY_CONFIG;
    TEST_ASSERT_EQUAL(Fapi_Status_Success, Fapi_initializeAPI(F021_CPU0_W0_BASE_ADDRESS, 200));
    TEST_ASSERT_EQUAL(Fapi_Status_Success, Fapi_setActiveFlashBank(Fapi_FlashBank0));
}

static Fapi_StatusType program_words(uint16_t *at, uint16_t *words, uint16_t count)
{
    return Fapi_issueProgrammingCommand((uint32 *)(void *)at, words, count, NULL, 0, Fapi_AutoEccGeneration);
}

static Fapi_StatusType erase(uint16_t *at)
{
    return Fapi_issueAsyncCommandWithAddress(Fapi_EraseSector, (uint32 *)(void *)at);
}

static void wait(void)
{
    TEST_ASSERT_EQUAL(Fapi_Status_FsmBusy, Fapi_checkFsmForReady());
    TEST_ASSERT_EQUAL(Fapi_Status_FsmReady, Fapi_checkFsmForReady());
}

void test_it_is_blank_at_first(void)
{
    TEST_ASSERT_EACH_EQUAL_HEX16(0xFFFF, flash_sectors_m_n[0], FLASH_SECTORS * FLASH_SECTOR_CELLS);
}

void test_nothing_goes_without_pump_library_and_bank_or_while_busy(void)
{
    TEST_ASSERT_NOT_EQUAL(Fapi_Status_Success, erase(flash_sectors_m_n[0]));
    start();
    TEST_ASSERT_NOT_EQUAL(Fapi_Status_Success, Fapi_initializeAPI(F021_CPU0_W0_BASE_ADDRESS, 194));
    TEST_ASSERT_NOT_EQUAL(Fapi_Status_Success, erase(flash_sectors_m_n[0]));
    start();
    Flash_releasePumpSemaphore(FLASHPUMPSEMAPHORE_BASE);
    TEST_ASSERT_NOT_EQUAL(Fapi_Status_Success, program_words(flash_sectors_m_n[0], block, 8));
    start();
    TEST_ASSERT_EQUAL(Fapi_Status_Success, erase(flash_sectors_m_n[0]));
    TEST_ASSERT_NOT_EQUAL(Fapi_Status_Success, erase(flash_sectors_m_n[0]));
    wait();
    TEST_ASSERT_EQUAL(Fapi_Status_Success, erase(flash_sectors_m_n[0]));
}

void test_programming_only_clears_bits_and_only_whole_blocks_once(void)
{
    static uint16_t ones[8];

    start();
    TEST_ASSERT_EQUAL(Fapi_Error_InvalidAddress, program_words(&flash_sectors_m_n[1][4], block, 8));
    TEST_ASSERT_EQUAL(Fapi_Error_AsyncIncorrectDataBufferLength,
                      program_words(flash_sectors_m_n[1], block, 4));
    TEST_ASSERT_EQUAL(Fapi_Error_InvalidAddress, program_words(ones, block, 8));
    TEST_ASSERT_EQUAL(Fapi_Status_Success, program_words(flash_sectors_m_n[1], block, 8));
    wait();
    TEST_ASSERT_EQUAL(0, Fapi_getFsmStatus());
    TEST_ASSERT_EQUAL_HEX16_ARRAY(block, flash_sectors_m_n[1], 8);
    memset(ones, 0, sizeof ones);
    TEST_ASSERT_EQUAL(Fapi_Status_Success, program_words(flash_sectors_m_n[1], ones, 8));
    wait();
    TEST_ASSERT_NOT_EQUAL(0, Fapi_getFsmStatus());
    TEST_ASSERT_EQUAL_HEX16_ARRAY(block, flash_sectors_m_n[1], 8);
}

void test_power_fails_at_the_cell_that_was_named_which_is_left_half_done(void)
{
    start();
    flash_cut_power_after(3);
    TEST_ASSERT_EQUAL(Fapi_Status_Success, program_words(flash_sectors_m_n[0], block, 8));
    wait();
    TEST_ASSERT_NOT_EQUAL(0, Fapi_getFsmStatus());
    TEST_ASSERT_EQUAL_HEX16_ARRAY(block, flash_sectors_m_n[0], 3);
    TEST_ASSERT_TRUE(flash_sectors_m_n[0][3] != 0xFFFF && flash_sectors_m_n[0][3] != block[3]);
    TEST_ASSERT_EACH_EQUAL_HEX16(0xFFFF, &flash_sectors_m_n[0][4], 100);
    TEST_ASSERT_EQUAL(3, flash_cells_changed());
    TEST_ASSERT_EQUAL(Fapi_Status_Success, erase(flash_sectors_m_n[0]));
    wait();
    TEST_ASSERT_EQUAL_HEX16_ARRAY_MESSAGE(block, flash_sectors_m_n[0], 3, "without power nothing is erased");
    flash_cut_power_after(-1);
    TEST_ASSERT_EQUAL(Fapi_Status_Success, erase(flash_sectors_m_n[0]));
    wait();
    TEST_ASSERT_EACH_EQUAL_HEX16(0xFFFF, flash_sectors_m_n[0], FLASH_SECTOR_CELLS);
}

void test_a_file_keeps_the_cells_and_what_is_programmed(void)
{
    start();
    (void)program_words(&flash_sectors_m_n[1][8], block, 8);
    wait();
    TEST_ASSERT_NULL(flash_store(path));
    flash_blank();
    TEST_ASSERT_NULL(flash_load(path));
    TEST_ASSERT_EQUAL_HEX16_ARRAY(block, &flash_sectors_m_n[1][8], 8);
    TEST_ASSERT_EACH_EQUAL_HEX16(0xFFFF, flash_sectors_m_n[1], 8);
    start();
    (void)program_words(&flash_sectors_m_n[1][8], block, 8);
    wait();
    TEST_ASSERT_NOT_EQUAL(0, Fapi_getFsmStatus());
}

void test_no_file_is_blank_and_a_short_one_is_refused(void)
{
    FILE *file;

    flash_sectors_m_n[0][0] = 0;
    TEST_ASSERT_NULL(flash_load(path));
    TEST_ASSERT_EQUAL_HEX16(0xFFFF, flash_sectors_m_n[0][0]);
    file = fopen(path, "wb");
    TEST_ASSERT_NOT_NULL(file);
    fputs("short", file);
    fclose(file);
    flash_sectors_m_n[0][0] = 0x77;
    TEST_ASSERT_EQUAL_STRING("no image of the storage: its length is not 32768 octets", flash_load(path));
    TEST_ASSERT_EQUAL_HEX16(0x77, flash_sectors_m_n[0][0]);
    TEST_ASSERT_EQUAL_STRING(strerror(ENOENT), flash_store(SCRATCH "/no such directory/flash.bin"));
}

static long size_of(const char *name)
{
    struct stat status;

    return stat(name, &status) == 0 ? (long)status.st_size : -1;
}

void test_a_longer_file_is_refused_too_and_so_is_what_is_no_file(void)
{
    FILE *file;

    TEST_ASSERT_NULL(flash_store(path));
    file = fopen(path, "ab");
    TEST_ASSERT_NOT_NULL(file);
    fputc(0, file);
    fclose(file);
    TEST_ASSERT_NOT_NULL(flash_load(path));
    TEST_ASSERT_EQUAL_STRING(strerror(EISDIR), flash_load(SCRATCH));
    TEST_ASSERT_NOT_NULL(flash_store(SCRATCH));
    TEST_ASSERT_EQUAL_STRING(strerror(ENOTDIR), flash_load("/dev/null/x"));
}

static int fresh_files(void)
{
    DIR *directory = opendir(SCRATCH);
    int count = 0;

    for (struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        count += strstr(entry->d_name, "flash.bin") != NULL && strstr(entry->d_name, ".new") != NULL;
    }
    closedir(directory);
    return count;
}

/* A reader that has the old file open goes on reading the old one: it was replaced, not overwritten. */
void test_a_store_replaces_the_file_in_one_step_and_leaves_nothing_else(void)
{
    static unsigned char octets[FLASH_SECTORS * FLASH_SECTOR_CELLS * 2];
    FILE *before;

    flash_sectors_m_n[0][0] = 0x1234;
    TEST_ASSERT_NULL(flash_store(path));
    before = fopen(path, "rb");
    flash_sectors_m_n[0][0] = 0x4321;
    TEST_ASSERT_NULL(flash_store(path));
    TEST_ASSERT_EQUAL_size_t(sizeof octets, fread(octets, 1, sizeof octets, before));
    fclose(before);
    TEST_ASSERT_EQUAL_HEX16(0x1234, octets[0] | octets[1] << 8);
    flash_blank();
    TEST_ASSERT_NULL(flash_load(path));
    TEST_ASSERT_EQUAL_HEX16(0x4321, flash_sectors_m_n[0][0]);
    TEST_ASSERT_EQUAL_INT(0, fresh_files());
}

void test_a_full_disk_leaves_the_old_file(void)
{
    struct stat status;

    if (stat("/dev/full", &status) != 0) {
        TEST_IGNORE_MESSAGE("no /dev/full");
    }
    flash_sectors_m_n[0][0] = 0x1234;
    TEST_ASSERT_NULL(flash_store(path));
    char fresh[300];
    snprintf(fresh, sizeof fresh, "%s.%ld.new", path, (long)getpid());
    TEST_ASSERT_EQUAL_INT(0, symlink("/dev/full", fresh));
    flash_sectors_m_n[0][0] = 0x4321;
    TEST_ASSERT_EQUAL_STRING(strerror(ENOSPC), flash_store(path));
    TEST_ASSERT_EQUAL_INT(0, fresh_files());
    TEST_ASSERT_NULL(flash_load(path));
    TEST_ASSERT_EQUAL_HEX16(0x1234, flash_sectors_m_n[0][0]);
}

void test_a_link_is_kept_and_what_it_names_is_replaced(void)
{
    static const char link_path[] = SCRATCH "/flash.link";
    struct stat status;

    (void)remove(link_path);
    TEST_ASSERT_NULL(flash_store(path));
    TEST_ASSERT_EQUAL_INT(0, symlink(path, link_path));
    flash_sectors_m_n[0][0] = 0x4321;
    TEST_ASSERT_NULL(flash_store(link_path));
    TEST_ASSERT_EQUAL_INT(0, lstat(link_path, &status));
    TEST_ASSERT_TRUE(S_ISLNK(status.st_mode));
    TEST_ASSERT_EQUAL(32768, size_of(path));
    (void)remove(link_path);
    flash_blank();
    TEST_ASSERT_NULL(flash_load(path));
    TEST_ASSERT_EQUAL_HEX16(0x4321, flash_sectors_m_n[0][0]);
}

void test_the_user_is_called_back_six_times_while_the_bank_is_made_active(void)
{
    start();
    TEST_ASSERT_EQUAL_INT(6, called_back);
    TEST_ASSERT_TRUE_MESSAGE(chip_protected_writable(), "the library leaves the registers open");
}

void test_stores_of_the_set_up_are_lost_behind_a_call_that_closes_the_registers(void)
{
    for (int call = 1; call <= 6; call++) {
        called_back = 0;
        closes_at = call;
        start();
        TEST_ASSERT_EQUAL(Fapi_Status_Success, erase(flash_sectors_m_n[0]));
        wait();
        TEST_ASSERT_NOT_EQUAL(0, Fapi_getFsmStatus());
        TEST_ASSERT_EQUAL(0, flash_cells_changed());
    }
    closes_at = 0;
    start();
    TEST_ASSERT_EQUAL(Fapi_Status_Success, erase(flash_sectors_m_n[0]));
    wait();
    TEST_ASSERT_EQUAL(0, Fapi_getFsmStatus());
}

void test_making_the_bank_active_with_the_error_correction_on_is_an_nmi(void)
{
    Flash_claimPumpSemaphore(FLASHPUMPSEMAPHORE_BASE, FLASH_BANK0_WRAPPER);
    (void)Fapi_initializeAPI(F021_CPU0_W0_BASE_ADDRESS, 200);
    TEST_ASSERT_NOT_EQUAL(Fapi_Status_Success, Fapi_setActiveFlashBank(Fapi_FlashBank0));
    TEST_ASSERT_EQUAL_UINT(1, chip_nmis());
    TEST_ASSERT_NOT_EQUAL_MESSAGE(Fapi_Status_Success, erase(flash_sectors_m_n[0]), "never made active");
}

void test_a_change_of_the_error_correction_is_in_force_behind_the_delay(void)
{
    TEST_ASSERT_TRUE(flash_corrects());
    Flash_disableECC(FLASH0ECC_BASE);
    TEST_ASSERT_TRUE(flash_corrects());
    FLASH_DELAY_CONFIG;
    TEST_ASSERT_FALSE(flash_corrects());
    Flash_enableECC(FLASH0ECC_BASE);
    TEST_ASSERT_FALSE(flash_corrects());
    FLASH_DELAY_CONFIG;
    TEST_ASSERT_TRUE(flash_corrects());
}

void test_the_librarys_flush_reads_a_bank_that_nobody_starts(void)
{
    start();
    TEST_ASSERT_EQUAL_UINT(0, chip_nmis());
    Fapi_flushPipeline();
    TEST_ASSERT_EQUAL_UINT(1, chip_nmis());
}
