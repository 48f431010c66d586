// Code that is wider than its page can be scrolled by keyboard.
for (const code of document.querySelectorAll('pre > code')) code.tabIndex = 0;
