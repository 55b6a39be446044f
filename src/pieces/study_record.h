/* SPDX-License-Identifier: GPL-3.0-or-later */
/* run.json: what the shards of a study have in common. The first process of the study writes it, all others compare. */
#pragma once
#include "pieces/shard.h"
#include "pieces/study_key.h"

#define STUDY_RECORD_FORMAT "twinbox shards 1"

/* Bytes of the file at most. */
enum { STUDY_RECORD_SIZE = 60000 };

/* The command line that runs the study, the folder in which its paths are, and its output. */
typedef struct StudyCommand {
    int argc;
    char **argv; /* [argc] "twinbox chart", then the arguments */
    char *folder, *output;
} StudyCommand;

/* study_record_free(), also after a failure. */
typedef struct StudyRecord {
    char *version;
    StudyKey key;
    int shards;
    JobArray array; /* of the first start; step 0: it was no job array */
    StudyCommand command;
} StudyRecord;

/* ERROR_INPUT with path:line:column if the file is missing, damaged, or no record. */
bool study_record_read(StudyRecord *record, const char *path, Error *error);
void study_record_free(StudyRecord *record);

/* What a process that starts would write. */
typedef struct StudyStart {
    const StudyKey *key;
    const ShardRequest *request;
    const char *output;
    int argc;
    char **argv;
} StudyStart;

/* Makes the file unless it is there. True with *record read in either case; the first writer wins. */
bool study_record_meet(StudyRecord *record, const char *path, const StudyStart *start, Error *error);

/* ERROR_INPUT unless this program, with this key and these arguments (argv NULL: not compared), does the recorded study:
   says what differs. */
bool study_record_check(const StudyRecord *record, const char *path, const StudyKey *key, int argc, char **argv,
                        Error *error);

/* The shard of the request in the recorded study: a retried job array has other bounds. ERROR_INPUT if N differs. */
bool study_record_shard(const StudyRecord *record, const char *path, const ShardRequest *request, Shard *shard,
                        Error *error);
