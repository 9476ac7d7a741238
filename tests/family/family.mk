# random members of families against answers from elsewhere: a few with a fixed seed in `make
# check`, any number in `make stress`, which calls each as `NAME --seed N --seconds N`
