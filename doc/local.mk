# manual, man page, and what in them is made from the program
info_TEXINFOS = doc/cotree.texi
doc_cotree_TEXINFOS = doc/cases.texi doc/reference.texi doc/example.c
AM_MAKEINFOFLAGS = --no-split -I doc
dist_man_MANS += doc/cotree.1
EXTRA_DIST += scripts/dev/docs

# write anew: the reference, the commands of the man page, the sessions of manual and README
docs: all
	$(srcdir)/scripts/dev/docs $(abs_builddir)/cotree
.PHONY: docs
