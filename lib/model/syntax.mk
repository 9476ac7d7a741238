# text to statements
