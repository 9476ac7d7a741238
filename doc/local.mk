# manual, man page, and what in them is made from the program
info_TEXINFOS = doc/cotree.texi
doc_cotree_TEXINFOS = doc/cases.texi doc/machines.texi doc/beams.texi doc/ports.texi doc/teaching.texi doc/reference.texi doc/theory.texi doc/example.c doc/controller.c doc/loop.c doc/fit.c doc/swing.py
AM_MAKEINFOFLAGS = --no-split -I doc
dist_man_MANS += doc/cotree.1
EXTRA_DIST += scripts/dev/docs doc/HACKING

# pictures: those of characters, for Info and plain text, and the README's are kept; the others are
# drawn by gnuplot
# when the manual is made as html or pdf
EXTRA_DIST += doc/pictures/list doc/pictures/drawn-andrews.svg \
	doc/pictures/arm.txt doc/pictures/converter.txt doc/pictures/crane.txt \
	doc/pictures/lift.txt doc/pictures/loudspeaker.txt doc/pictures/maglev.txt \
	doc/pictures/microphone.txt doc/pictures/slider-crank.txt \
	doc/pictures/drawn-crank.txt \
	doc/pictures/drawn-arm.txt \
	doc/pictures/drawn-andrews.txt \
	doc/pictures/drawn-four-bar.txt \
	doc/pictures/drawn-serial.txt \
	doc/pictures/drawn-spatial.txt \
	doc/pictures/drawn-crane.txt doc/pictures/drawn-bent.txt \
	doc/pictures/drawn-top.txt \
	doc/pictures/drawn-pendulum.txt \
	doc/pictures/drawn-microphone.txt \
	doc/pictures/drawn-loudspeaker.txt \
	doc/pictures/drawn-lift.txt \
	doc/pictures/drawn-graph.txt \
	doc/pictures/drawn-boxes.txt \
	doc/pictures/drawn-ports.txt doc/pictures/platform.txt doc/pictures/robot-torques.txt
# what is made stands in the folder of the build
doc/cotree.pdf doc/cotree.dvi: export TEXINPUTS = doc:$(srcdir)/doc:
doc/cotree.html doc/cotree.pdf doc/cotree.dvi: doc/pictures/drawn
doc/pictures/drawn: doc/pictures/list tests/bench/precision.dat tests/bench/scaling.dat cotree$(EXEEXT)
	$(srcdir)/scripts/dev/pictures ./cotree png doc/pictures
	$(srcdir)/scripts/dev/precision-pictures $(srcdir)/tests/bench/precision.dat png doc/pictures
	$(srcdir)/scripts/dev/scaling-pictures $(srcdir)/tests/bench/scaling.dat png doc/pictures
	@touch $@
drawn_pictures = \
	doc/pictures/arm.png doc/pictures/converter.png doc/pictures/crane.png \
	doc/pictures/lift.png doc/pictures/loudspeaker.png doc/pictures/maglev.png \
	doc/pictures/microphone.png doc/pictures/slider-crank.png \
	doc/pictures/drawn-crank.png \
	doc/pictures/drawn-arm.png \
	doc/pictures/drawn-andrews.png \
	doc/pictures/drawn-four-bar.png \
	doc/pictures/drawn-serial.png \
	doc/pictures/drawn-spatial.png \
	doc/pictures/drawn-crane.png doc/pictures/drawn-bent.png \
	doc/pictures/drawn-top.png \
	doc/pictures/drawn-pendulum.png \
	doc/pictures/drawn-microphone.png \
	doc/pictures/drawn-loudspeaker.png \
	doc/pictures/drawn-lift.png \
	doc/pictures/drawn-graph.png \
	doc/pictures/drawn-boxes.png \
	doc/pictures/drawn-ports.png doc/pictures/platform.png doc/pictures/robot-torques.png \
	doc/pictures/work-andrews_absolute.png doc/pictures/work-bushing.png \
	doc/pictures/scaling.png doc/pictures/work-double_pendulum.png doc/pictures/work-rectifier.png
CLEANFILES += doc/pictures/drawn $(drawn_pictures)

# the pages name them as they stand beside the manual: pictures/arm.png
install-html-local: doc/pictures/drawn
	$(MKDIR_P) "$(DESTDIR)$(htmldir)/pictures"
	$(INSTALL_DATA) $(drawn_pictures) "$(DESTDIR)$(htmldir)/pictures"
uninstall-local:
	cd "$(DESTDIR)$(htmldir)" 2>/dev/null && rm -f $(drawn_pictures:doc/%=%) && \
		rmdir pictures 2>/dev/null || :

# write anew: the reference, the commands of the man page, the sessions and the pictures of
# characters of the manual, the sessions of the README
docs: all
	$(srcdir)/scripts/dev/docs $(abs_builddir)/cotree
	$(srcdir)/scripts/dev/pictures $(abs_builddir)/cotree txt $(srcdir)/doc/pictures
.PHONY: docs
