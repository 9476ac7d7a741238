# sources that write files of other formats
