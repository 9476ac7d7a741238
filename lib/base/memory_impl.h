/* memory_impl.h: what pieces, transactions and faults share */
#ifndef COTREE_BASE_MEMORY_IMPL_H
#define COTREE_BASE_MEMORY_IMPL_H

#include "base/transaction.h"

/* A piece of the system's, which belongs to no transaction; NULL: memory has ended. */
void *system_allocate(size_t size, bool zeroed);
/* A piece of the current transaction, if there is one; leaves the transaction when out of
 * memory. */
MemPiece *piece_new(size_t size, bool zeroed, const void *maker);
/* Change the size; the piece may move. The old piece stays allocated if a transaction may have to
 * restore it. */
MemPiece *piece_resize(MemPiece *piece, size_t size, const void *maker);
/* Free a piece: at once, or at the end of the transaction. */
void piece_drop(MemPiece *piece);

/* --- faults.c --- */

#ifdef COTREE_FAULTS
enum { FAULTS = true };
void faults_begin(Transaction *transaction);
/* After the rollback of a trial: start the next one. */
void faults_next(Transaction *transaction);
bool faults_strike(void); /* whether this allocation fails */
/* All pieces that the call found are as they were, or the program ends. */
void faults_check(void);
/* No scratch points to a piece that a failure is about to free, or the program ends. */
void faults_look_for(const MemPiece *made);
/* pieces that belong to no transaction */
void faults_know(MemPiece *piece);
void faults_forget(MemPiece *piece);
#else
enum { FAULTS = false };
static inline void faults_begin(Transaction *transaction)
{
    transaction->trial = -1;
}
static inline void faults_next(Transaction *transaction)
{
    (void)transaction;
}
static inline bool faults_strike(void)
{
    return false;
}
static inline void faults_check(void) {}
static inline void faults_look_for(const MemPiece *made)
{
    (void)made;
}
static inline void faults_know(MemPiece *piece)
{
    (void)piece;
}
static inline void faults_forget(MemPiece *piece)
{
    (void)piece;
}
#endif

#endif
