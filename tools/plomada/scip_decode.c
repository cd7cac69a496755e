#include <stdio.h>
#include <string.h>

#include "scip.h"
#include "scip_reader.h"

static const char usage[] =
    "usage: plomada scip decode FILE|-\n\n"
    "Reads what a scanner sent (raw octets) and writes its scans as CSV: timestamp_ms,n,d0,d1,... one line "
    "per scan, time\n"
    "stamps and values as sent (24 bits; mm, below 20 a code). Echo lines in the stream say what was asked "
    "for: MS, MD,\n"
    "GS, GD. Other packets are skipped. A damaged frame gives no line. A summary goes to stderr.\n\n"
    "Exit status: 0 scans were found, 1 none, 2 usage or unreadable file.\n";

static void write_scan(void *context, const scip_scan_t *scan)
{
    FILE *out = context;

    fprintf(out, "%lu,%u", (unsigned long)scan->timestamp_ms, scan->points);
    for (uint16_t i = 0; i < scan->points; i++) {
        fprintf(out, ",%u", scan->distance_mm[i]);
    }
    fputc('\n', out);
}

int scip_decode(int argc, char **argv)
{
    static scip_reader_t reader;
    const char *error;

    if (argc != 2 || strcmp(argv[1], "--help") == 0) {
        fputs(usage, argc == 2 ? stdout : stderr);
        return argc == 2 ? 0 : 2;
    }
    scip_reader_init(&reader, write_scan, stdout);
    printf("timestamp_ms,n,d0,d1,...\n");
    error = scip_reader_file(&reader, argv[1]);
    if (error != NULL) {
        fprintf(stderr, "plomada scip decode: %s: %s\n", argv[1], error);
        return 2;
    }
    if (fflush(stdout) != 0 || ferror(stdout)) {
        perror("plomada scip decode: stdout");
        return 2;
    }
    scip_reader_print(&reader, stderr);
    return reader.totals.scans > 0 ? 0 : 1;
}
