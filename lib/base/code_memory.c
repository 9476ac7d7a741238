/* code_memory.c: memory that a processor runs: pages of the system's */
#include "base/code_memory.h"

#include "base/memory.h"

#include <string.h>

#if defined __x86_64__ && defined __unix__
#include <sys/mman.h>

struct CodeMemory {
    void *at;
    size_t size;
    Cleanup cleanup;
};

static void give_back(void *object)
{
    CodeMemory *memory = object;

    if (memory->at != NULL)
        (void)munmap(memory->at, memory->size);
    memory->at = NULL;
    cleanup_close(&memory->cleanup);
}

CodeMemory *code_memory_new(const void *bytes, size_t size)
{
    CodeMemory *memory = NEW(CodeMemory);
    void *at = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);

    if (at == MAP_FAILED) {
        mem_free(memory);
        return NULL;
    }
    memory->at = at;
    memory->size = size;
    cleanup_open(&memory->cleanup, give_back, memory);
    memcpy(at, bytes, size);
    if (mprotect(at, size, PROT_READ | PROT_EXEC) == 0)
        return memory;
    code_memory_free(memory);
    return NULL;
}

void code_memory_free(CodeMemory *memory)
{
    if (memory == NULL)
        return;
    give_back(memory);
    mem_free(memory);
}

const void *code_memory_at(const CodeMemory *memory)
{
    return memory->at;
}

bool code_memory_is_there(void)
{
    static const unsigned char leave = 0xC3;
    CodeMemory *memory = code_memory_new(&leave, 1);
    const bool is_there = memory != NULL;

    code_memory_free(memory);
    return is_there;
}

#else

CodeMemory *code_memory_new(const void *bytes, size_t size)
{
    (void)bytes, (void)size;
    return NULL;
}

void code_memory_free(CodeMemory *memory)
{
    (void)memory;
}

const void *code_memory_at(const CodeMemory *memory)
{
    (void)memory;
    return NULL;
}

bool code_memory_is_there(void)
{
    return false;
}

#endif
