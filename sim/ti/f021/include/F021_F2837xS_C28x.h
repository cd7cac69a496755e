/* Stand-in for TI's F021 flash API (F2837xS), version 1.55: the subset that this firmware uses, same names
 * and types. As in TI's library each function turns EALLOW on where it begins, and none turns it off; a store
 * after an EDIS of the function that it calls back is lost. */
#ifndef F021_F2837XS_C28X_H
#define F021_F2837XS_C28X_H

#include <stdint.h>

typedef uint16_t uint16;
typedef uint32_t uint32;

typedef enum { Fapi_FlashBank0, Fapi_FlashBank1 } Fapi_FlashBankType;

typedef enum {
    Fapi_AutoEccGeneration,
    Fapi_DataOnly,
    Fapi_EccOnly,
    Fapi_DataAndEcc
} Fapi_FlashProgrammingCommandsType;

typedef enum { Fapi_ProgramData = 0x0002, Fapi_EraseSector = 0x0006 } Fapi_FlashStateCommandsType;

typedef enum {
    Fapi_Status_Success = 0,
    Fapi_Status_FsmBusy,
    Fapi_Status_FsmReady,
    Fapi_Error_Fail = 500,
    Fapi_Error_InvalidHclkValue = 504,
    Fapi_Error_InvalidCpu,
    Fapi_Error_InvalidBank,
    Fapi_Error_InvalidAddress,
    Fapi_Error_AsyncIncorrectDataBufferLength = 509
} Fapi_StatusType;

typedef uint32 Fapi_FlashStatusType;

typedef struct {
    uint32 stand__in;
} Fapi_FmcRegistersType;

extern Fapi_FmcRegistersType f021_registers;
#define F021_CPU0_W0_BASE_ADDRESS (&f021_registers)

/* u32HclkFrequency: MHz. */
Fapi_StatusType Fapi_initializeAPI(Fapi_FmcRegistersType *poFlashControlRegister, uint32 u32HclkFrequency);
Fapi_StatusType Fapi_setActiveFlashBank(Fapi_FlashBankType oNewFlashBank);
Fapi_StatusType Fapi_issueAsyncCommandWithAddress(Fapi_FlashStateCommandsType oCommand,
                                                  uint32 *pu32StartAddress);
Fapi_StatusType Fapi_issueProgrammingCommand(uint32 *pu32StartAddress, uint16 *pu16DataBuffer,
                                             uint16 u16DataBufferSizeInWords, uint16 *pu16EccBuffer,
                                             uint16 u16EccBufferSizeInBytes,
                                             Fapi_FlashProgrammingCommandsType oMode);
Fapi_StatusType Fapi_checkFsmForReady(void);
Fapi_FlashStatusType Fapi_getFsmStatus(void);
void Fapi_flushPipeline(void);

/* The user's, called back while the library works: six times by Fapi_setActiveFlashBank(). */
Fapi_StatusType Fapi_serviceWatchdogTimer(void);

#endif
